// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <framewatch/acknowledged_t.hpp>
#include <framewatch/action_status_t.hpp>
#include <framewatch/can_status_t.hpp>
#include <framewatch/event_t.hpp>
#include <framewatch/gap_t.hpp>
#include <framewatch/history_status_t.hpp>
#include <framewatch/model_fit_t.hpp>
#include <framewatch/mqtt_status_t.hpp>
#include <framewatch/parameter_table_t.hpp>
#include <framewatch/reception_t.hpp>
#include <framewatch/service_t.hpp>
#include <framewatch/session_status_t.hpp>
#include <framewatch/status_t.hpp>
#include <framewatch/uplink_status_t.hpp>
#include <framewatch/watch_t.hpp>
#include <framewatch/weather_status_t.hpp>
#include <framewatch/window_estimate_t.hpp>

namespace framewatch::daemon {

/// The messages that have one LCM channel each, in the order of LatestMessages' table.
enum class DaemonMessage {
  service,
  status,
  parameters,
  estimate,
  gap,
  model_fit,
  watch,
  weather,
  can,
  mqtt,
  history,
  actions,
  acknowledged,
  reception,
  session,
  uplink,
  event
};

/// Keeps the latest message of each LCM channel that the services of a building publish. Call
/// update() with every message, then read the member that it names. Not thread-safe.
class LatestMessages {
 public:
  /// prefix: begins the name of each channel (LcmSettings::prefix); may be empty.
  explicit LatestMessages(std::string prefix) : prefix_(std::move(prefix)) {}

  /// Checks and decodes a payload, stores it in its member and returns which one changed. Returns
  /// nullopt and changes nothing when the channel is not in the table or the payload is malformed.
  std::optional<DaemonMessage> update(std::string_view channel,
                                      std::span<const std::uint8_t> payload);
  /// Empties the member of `message`.
  void forget(DaemonMessage message);

  /// Returns the LCM channels of `messages`, with the prefix, in the same order.
  std::vector<std::string> channels(const std::vector<DaemonMessage>& messages) const;
  /// Returns the name of the LCM type of `message`: "status_t".
  static const char* type_name(DaemonMessage message);

  std::optional<service_t> service;
  std::optional<status_t> status;
  std::optional<parameter_table_t> parameters;
  std::optional<window_estimate_t> estimate;  ///< of the main window
  std::optional<gap_t> gap;
  std::optional<model_fit_t> model_fit;
  std::optional<watch_t> watch;
  std::optional<weather_status_t> weather;
  std::optional<can_status_t> can;
  std::optional<mqtt_status_t> mqtt;
  std::optional<history_status_t> history;
  std::optional<action_status_t> actions;
  std::optional<acknowledged_t> acknowledged;
  std::optional<reception_t> reception;
  std::optional<session_status_t> session;
  std::optional<uplink_status_t> uplink;
  std::optional<event_t> event;

 private:
  std::string prefix_;
};

}  // namespace framewatch::daemon
