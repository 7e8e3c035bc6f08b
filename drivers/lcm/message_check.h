// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace framewatch::drivers {

/// Returns the fingerprint at the start of a payload. Returns nullopt when the payload is too
/// short.
std::optional<std::int64_t> fingerprint(std::span<const std::uint8_t> payload);

/// Returns true if the payload has this fingerprint, if that is of a message in lcmtypes/, and if
/// every array length, every string and the total size fit that message.
bool is_well_formed(std::span<const std::uint8_t> payload, std::int64_t fingerprint);

/// Decodes a payload from an untrusted sender: decoded<status_t>(payload). Checks lengths before
/// the generated decoder, which would allocate whatever a length says. Returns nullopt when the
/// payload is not well-formed.
template <typename Type>
std::optional<Type> decoded(std::span<const std::uint8_t> payload) {
  if (!is_well_formed(payload, Type::getHash())) return std::nullopt;
  Type message{};
  const int size = static_cast<int>(payload.size());
  if (message.decode(payload.data(), 0, size) != size) return std::nullopt;
  return message;
}

/// Returns the type of a message by its fingerprint, such as "accel_t". Returns null for a
/// fingerprint that this version does not know.
const char* known_type(std::int64_t fingerprint);

/// Returns the type of messages on a channel of framewatch by the channel's name. `prefix` is
/// lcm.prefix of the configuration. Returns null for any other name.
const char* type_of_lcm_channel(const std::string& channel,
                                const std::string& prefix = "FRAMEWATCH_");

/// Returns why a payload on a channel of `type` is not of that type, as a sentence without its end:
/// another type of ours, too short, damaged, or a fingerprint unknown to this version.
std::string why_not(const std::string& type, std::span<const std::uint8_t> payload);

}  // namespace framewatch::drivers
