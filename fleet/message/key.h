#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <framewatch/event_t.hpp>

namespace framewatch::fleet {

/// What identifies an event at the hub: made of its content, so that a repetition changes nothing.
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

/// The keys as text (Nats-Msg-Id), <building>/event/<kind>/<id>/<time_us>/<state> and
/// <building>/summary/<period_s>/<start_us>. A kind that has a slash or a control character keeps
/// it as %XX.
std::string message_key(std::string_view building, const EventKey& key);
std::string message_key(std::string_view building, const SummaryKey& key);
/// <building>/raw/<request>/<piece>
std::string raw_key(std::string_view building, std::string_view request, std::int64_t piece);
/// <building>/<kind>/<time_us>, of what the hub keeps the newest of.
std::string newest_key(std::string_view building, std::string_view kind, std::int64_t time_us);

/// KEY~DIGITS, what is given to the hub as Nats-Msg-Id. The hub takes a message whose Nats-Msg-Id
/// it has heard within minutes for a repetition, whoever sent it: so nobody who does not have the
/// `secret` can say it before the building, and other content under the same key is another
/// message.
std::string sealed_key(std::string_view key, std::string_view secret,
                       std::span<const std::uint8_t> content);
/// The key alone, of what sealed_key() made or of a key.
std::string_view key_of_sealed(std::string_view sealed);

/// Of any key: before its first slash, and what stands until the next. Empty when it is no key.
struct KeyParts {
  std::string building, kind;
};
std::optional<KeyParts> key_parts(std::string_view key);

}  // namespace framewatch::fleet
