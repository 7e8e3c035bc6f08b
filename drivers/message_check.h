#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <framewatch/accel_counts_t.hpp>
#include <framewatch/acknowledge_t.hpp>
#include <framewatch/acknowledged_t.hpp>
#include <framewatch/action_status_t.hpp>
#include <framewatch/can_status_t.hpp>
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

namespace framewatch::drivers {

/// The fingerprint a payload begins with; empty when it is shorter than one.
std::optional<std::int64_t> fingerprint(std::span<const std::uint8_t> payload);

/// Decodes after checking fingerprint, every array and string length and the total size: the
/// generated decoders allocate whatever a length says. Empty when anything is not as it must be.
std::optional<parameter_table_t> decode_parameter_table(std::span<const std::uint8_t> payload);
std::optional<window_estimate_t> decode_window_estimate(std::span<const std::uint8_t> payload);
std::optional<status_t> decode_status(std::span<const std::uint8_t> payload);
std::optional<event_t> decode_event(std::span<const std::uint8_t> payload);
std::optional<gap_t> decode_gap(std::span<const std::uint8_t> payload);
std::optional<can_status_t> decode_can_status(std::span<const std::uint8_t> payload);
std::optional<accel_counts_t> decode_accel_counts(std::span<const std::uint8_t> payload);
std::optional<watch_t> decode_watch(std::span<const std::uint8_t> payload);
std::optional<history_status_t> decode_history_status(std::span<const std::uint8_t> payload);
std::optional<session_command_t> decode_session_command(std::span<const std::uint8_t> payload);
std::optional<session_status_t> decode_session_status(std::span<const std::uint8_t> payload);
std::optional<action_status_t> decode_action_status(std::span<const std::uint8_t> payload);
std::optional<acknowledge_t> decode_acknowledge(std::span<const std::uint8_t> payload);
std::optional<acknowledged_t> decode_acknowledged(std::span<const std::uint8_t> payload);
std::optional<service_t> decode_service(std::span<const std::uint8_t> payload);
std::optional<temperature_t> decode_temperature(std::span<const std::uint8_t> payload);

}  // namespace framewatch::drivers
