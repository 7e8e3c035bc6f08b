// SPDX-License-Identifier: MIT
#include "daemon/monitor/service/latest_messages.h"

#include <algorithm>
#include <iterator>

#include "drivers/lcm/message_check.h"

namespace framewatch::daemon {
namespace {

struct MessageChannel {
  std::string_view suffix;  ///< of the channel's name, after the prefix
  const char* (*type_name)();
  bool (*update)(LatestMessages& out, std::span<const std::uint8_t> payload);
  void (*forget)(LatestMessages& out);
};

template <typename Message, std::optional<Message> LatestMessages::*kMember>
constexpr MessageChannel entry_of(std::string_view suffix) {
  return {suffix, [] { return Message::getTypeName(); },
          [](LatestMessages& out, std::span<const std::uint8_t> payload) {
            auto message = drivers::decoded<Message>(payload);
            if (!message) return false;
            out.*kMember = std::move(message);
            return true;
          },
          [](LatestMessages& out) { (out.*kMember).reset(); }};
}

/// By DaemonMessage.
const MessageChannel kMessageChannels[] = {
    entry_of<service_t, &LatestMessages::service>("SERVICE"),
    entry_of<status_t, &LatestMessages::status>("STATUS"),
    entry_of<parameter_table_t, &LatestMessages::parameters>("PARAMETERS"),
    entry_of<window_estimate_t, &LatestMessages::estimate>("ESTIMATE"),
    entry_of<gap_t, &LatestMessages::gap>("GAP"),
    entry_of<model_fit_t, &LatestMessages::model_fit>("MODEL_FIT"),
    entry_of<watch_t, &LatestMessages::watch>("WATCH"),
    entry_of<weather_status_t, &LatestMessages::weather>("WEATHER"),
    entry_of<can_status_t, &LatestMessages::can>("CAN"),
    entry_of<mqtt_status_t, &LatestMessages::mqtt>("MQTT"),
    entry_of<history_status_t, &LatestMessages::history>("HISTORY"),
    entry_of<action_status_t, &LatestMessages::actions>("ACTIONS"),
    entry_of<acknowledged_t, &LatestMessages::acknowledged>("ACKNOWLEDGED"),
    entry_of<reception_t, &LatestMessages::reception>("RECEPTION"),
    entry_of<session_status_t, &LatestMessages::session>("SESSION"),
    entry_of<uplink_status_t, &LatestMessages::uplink>("UPLINK"),
    entry_of<event_t, &LatestMessages::event>("EVENT"),
};
static_assert(std::size(kMessageChannels) == static_cast<std::size_t>(DaemonMessage::event) + 1);

const MessageChannel& entry_of(DaemonMessage message) {
  return kMessageChannels[static_cast<std::size_t>(message)];
}

}  // namespace

std::optional<DaemonMessage> LatestMessages::update(std::string_view channel,
                                                    std::span<const std::uint8_t> payload) {
  if (!channel.starts_with(prefix_)) return std::nullopt;
  const std::string_view suffix = channel.substr(prefix_.size());
  const auto at = std::ranges::find(kMessageChannels, suffix, &MessageChannel::suffix);
  if (at == std::end(kMessageChannels) || !at->update(*this, payload)) return std::nullopt;
  return static_cast<DaemonMessage>(at - std::begin(kMessageChannels));
}

void LatestMessages::forget(DaemonMessage message) {
  entry_of(message).forget(*this);
}

std::vector<std::string> LatestMessages::channels(
    const std::vector<DaemonMessage>& messages) const {
  std::vector<std::string> out;
  for (const DaemonMessage message : messages)
    out.push_back(prefix_ + std::string(entry_of(message).suffix));
  return out;
}

const char* LatestMessages::type_name(DaemonMessage message) {
  return entry_of(message).type_name();
}

}  // namespace framewatch::daemon
