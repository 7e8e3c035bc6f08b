#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace framewatch::drivers {

/// The fingerprint a payload begins with; empty when it is shorter than one.
std::optional<std::int64_t> fingerprint(std::span<const std::uint8_t> payload);

/// Whether the payload's fingerprint is this one, of a message in lcmtypes/, and every array
/// length, every string and the total size are as that message has them.
bool is_well_formed(std::span<const std::uint8_t> payload, std::int64_t fingerprint);

/// The message in a payload from an untrusted sender: decoded<status_t>(payload). Lengths are
/// checked before the generated decoder, which allocates whatever a length says, sees them. Empty
/// when the payload is not well-formed.
template <typename Type>
std::optional<Type> decoded(std::span<const std::uint8_t> payload) {
  if (!is_well_formed(payload, Type::getHash())) return std::nullopt;
  Type message{};
  const int size = static_cast<int>(payload.size());
  if (message.decode(payload.data(), 0, size) != size) return std::nullopt;
  return message;
}

}  // namespace framewatch::drivers
