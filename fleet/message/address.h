// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <framewatch/event_t.hpp>

namespace framewatch::fleet {

/// Returns true for 1 to 32 of a-z, 0-9 and -, except "all", which addresses every building.
bool is_building_name(std::string_view name);

/// Returns fw.up.<building>.<kind>, for messages of a building. A kind may have dots: summary.600,
/// raw.17.
std::string up_subject(std::string_view building, std::string_view kind);
/// Returns fw.down.<building>.<verb>, for commands. building: "all" addresses every building.
std::string down_subject(std::string_view building, std::string_view verb);

/// The parts of a subject.
struct SubjectParts {
  std::string building, kind;  ///< kind: or verb
};
/// Return nullopt if `subject` has another form.
std::optional<SubjectParts> up_parts(std::string_view subject);
std::optional<SubjectParts> down_parts(std::string_view subject);

/// Identifies an event at the hub by its content, so that a repetition changes nothing.
struct EventKey {
  std::string kind;
  std::int64_t id = 0, time_us = 0;
  std::int32_t state = 0;

  auto operator<=>(const EventKey&) const = default;
};

struct SummaryKey {
  std::int64_t period_s = 0, start_us = 0;

  auto operator<=>(const SummaryKey&) const = default;
};

EventKey event_key(const event_t& event);

/// Return the keys as text (Nats-Msg-Id): <building>/event/<kind>/<id>/<time_us>/<state> and
/// <building>/summary/<period_s>/<start_us>. Slashes and control characters in the kind become %XX.
std::string message_key(std::string_view building, const EventKey& key);
std::string message_key(std::string_view building, const SummaryKey& key);
/// Returns <building>/raw/<request>/<piece>.
std::string raw_key(std::string_view building, std::string_view request, std::int64_t piece);
/// Returns <building>/<kind>/<time_us>, for messages of which the hub keeps only the newest.
std::string newest_key(std::string_view building, std::string_view kind, std::int64_t time_us);

/// Returns KEY~DIGITS, the Nats-Msg-Id that the hub receives. The digits depend on the `secret` and
/// the content. The hub drops a message whose Nats-Msg-Id it saw within the last minutes, from any
/// sender; the seal keeps others from using the building's ids first, and makes other content under
/// the same key a new message.
std::string sealed_key(std::string_view key, std::string_view secret,
                       std::span<const std::uint8_t> content);
/// Removes the seal of sealed_key(). Returns other keys unchanged.
std::string_view key_of_sealed(std::string_view sealed);

/// The first two parts of any key.
struct KeyParts {
  std::string building, kind;
};
/// Returns nullopt if `key` is not a key.
std::optional<KeyParts> key_parts(std::string_view key);

}  // namespace framewatch::fleet
