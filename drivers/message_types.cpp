#include "drivers/message_types.h"

#include <array>
#include <utility>

#include <framewatch/accel_counts_t.hpp>
#include <framewatch/accel_t.hpp>
#include <framewatch/acknowledge_t.hpp>
#include <framewatch/acknowledged_t.hpp>
#include <framewatch/action_status_t.hpp>
#include <framewatch/can_status_t.hpp>
#include <framewatch/channel_table_t.hpp>
#include <framewatch/event_t.hpp>
#include <framewatch/gap_t.hpp>
#include <framewatch/history_status_t.hpp>
#include <framewatch/parameter_table_t.hpp>
#include <framewatch/service_t.hpp>
#include <framewatch/session_command_t.hpp>
#include <framewatch/session_status_t.hpp>
#include <framewatch/status_t.hpp>
#include <framewatch/temperature_t.hpp>
#include <framewatch/watch_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include <fmt/core.h>

#include "drivers/channel_table.h"
#include "drivers/message_check.h"

namespace framewatch::drivers {
namespace {

const std::array<std::pair<const char*, std::int64_t>, 18>& types() {
  static const std::array<std::pair<const char*, std::int64_t>, 18> all{{
      {"accel_t", accel_t::getHash()},
      {"channel_table_t", channel_table_t::getHash()},
      {"parameter_table_t", parameter_table_t::getHash()},
      {"window_estimate_t", window_estimate_t::getHash()},
      {"status_t", status_t::getHash()},
      {"event_t", event_t::getHash()},
      {"gap_t", gap_t::getHash()},
      {"can_status_t", can_status_t::getHash()},
      {"session_command_t", session_command_t::getHash()},
      {"session_status_t", session_status_t::getHash()},
      {"service_t", service_t::getHash()},
      {"accel_counts_t", accel_counts_t::getHash()},
      {"history_status_t", history_status_t::getHash()},
      {"temperature_t", temperature_t::getHash()},
      {"action_status_t", action_status_t::getHash()},
      {"acknowledge_t", acknowledge_t::getHash()},
      {"acknowledged_t", acknowledged_t::getHash()},
      {"watch_t", watch_t::getHash()},
  }};
  return all;
}

}  // namespace

const char* known_type(std::int64_t fingerprint) {
  for (const auto& [name, hash] : types())
    if (hash == fingerprint) return name;
  return nullptr;
}

const char* type_of_channel(const std::string& channel, const std::string& prefix) {
  if (!stream_of_table(channel).empty()) return "channel_table_t";
  if (channel.starts_with("ACCEL")) return "accel_t";
  if (channel == "COUNTS") return "accel_counts_t";
  if (channel == "TEMPERATURE") return "temperature_t";
  if (!channel.starts_with(prefix)) return nullptr;
  const std::string rest = channel.substr(prefix.size());
  if (rest.starts_with("ESTIMATE")) return "window_estimate_t";
  if (rest == "PARAMETERS") return "parameter_table_t";
  if (rest == "STATUS") return "status_t";
  if (rest == "EVENT") return "event_t";
  if (rest == "GAP") return "gap_t";
  if (rest == "WATCH") return "watch_t";
  if (rest == "CAN") return "can_status_t";
  if (rest == "SERVICE") return "service_t";
  if (rest == "HISTORY") return "history_status_t";
  if (rest == "ACKNOWLEDGE") return "acknowledge_t";
  if (rest == "ACKNOWLEDGED") return "acknowledged_t";
  if (rest == "ACTIONS") return "action_status_t";
  if (rest == "SESSION") return "session_status_t";
  if (rest == "SESSION_COMMAND") return "session_command_t";
  return nullptr;
}

std::string why_not(const std::string& type, std::span<const std::uint8_t> payload) {
  const std::optional<std::int64_t> found = fingerprint(payload);
  if (!found) return fmt::format("{} bytes are no {}", payload.size(), type);
  const char* known = known_type(*found);
  if (known != nullptr && known == type)
    return fmt::format("a damaged {}: its lengths do not fit its size", type);
  if (known != nullptr) return fmt::format("{} where {} belongs", known, type);
  return fmt::format(
      "no {0} as framewatch {1} knows it (fingerprint {2:016x}): the bytes are damaged or foreign, "
      "or a newer framewatch wrote them with a newer {0}; read them with that one",
      type, FRAMEWATCH_VERSION, static_cast<std::uint64_t>(*found));
}

}  // namespace framewatch::drivers
