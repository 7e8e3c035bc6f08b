// SPDX-License-Identifier: MIT
#include "fleet/uplink/newest_messages.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace framewatch::fleet {
namespace {

using daemon::DaemonMessage;

constexpr const char *kService = "service", *kAcknowledged = "acknowledged";

struct HubKind {
  DaemonMessage message;
  const char* kind;
};
constexpr HubKind kHubKinds[] = {
    {DaemonMessage::service, kService},           {DaemonMessage::status, "status"},
    {DaemonMessage::history, "history"},          {DaemonMessage::watch, "watch"},
    {DaemonMessage::acknowledged, kAcknowledged}, {DaemonMessage::parameters, "parameters"},
};

std::int64_t interval_us(const std::string& kind) {
  if (kind == kService) return NewestMessages::kService_us;
  for (const HubKind& one : kHubKinds)
    if (kind == one.kind) return NewestMessages::kOther_us;
  return NewestMessages::kText_us;
}

}  // namespace

std::vector<DaemonMessage> NewestMessages::messages() {
  std::vector<DaemonMessage> out;
  for (const HubKind& one : kHubKinds) out.push_back(one.message);
  return out;
}

void NewestMessages::update(const daemon::LatestMessages& latest, DaemonMessage changed,
                            std::span<const std::uint8_t> payload) {
  const auto* at = std::ranges::find(kHubKinds, changed, &HubKind::message);
  if (at == std::end(kHubKinds)) return;
  if (changed == DaemonMessage::service) {
    config_is(latest.service->config_sha256);
    if (std::exchange(raised_, latest.service->event_id) != latest.service->event_id)
      newest_[kService].given_us.reset();
  } else if (changed == DaemonMessage::acknowledged) {
    if (std::exchange(acknowledged_, latest.acknowledged->id) != latest.acknowledged->id)
      newest_[kAcknowledged].given_us.reset();
  } else if (changed == DaemonMessage::parameters) {
    config_is(latest.parameters->config_sha256);
  }
  Newest& newest = newest_[at->kind];
  newest.type = daemon::LatestMessages::type_name(changed);
  newest.content.assign(payload.begin(), payload.end());
}

void NewestMessages::config_is(const std::string& sha256) {
  if (std::exchange(config_sha256_, sha256) != sha256) restart();
}

void NewestMessages::set_text(const std::string& kind, const std::string& type,
                              const std::string& content) {
  newest_[kind] = {type, {content.begin(), content.end()}, {}};
}

void NewestMessages::restart() {
  for (auto& [kind, newest] : newest_) newest.given_us.reset();
}

std::optional<NewestMessages::Due> NewestMessages::due(std::int64_t now_us) {
  for (auto& [kind, newest] : newest_) {
    if (newest.content.empty()) continue;
    if (newest.given_us && now_us - *newest.given_us < interval_us(kind)) continue;
    newest.given_us = now_us;
    return Due{kind, newest.type, newest.content};
  }
  return std::nullopt;
}

}  // namespace framewatch::fleet
