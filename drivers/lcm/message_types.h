#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace framewatch::drivers {

/// Type of a message by its fingerprint, "accel_t" and so on; null when it is none of ours as they
/// are now.
const char* known_type(std::int64_t fingerprint);

/// Type that a channel of ours carries, by its name: prefix is lcm.prefix of the configuration.
/// Null for a name that says nothing.
const char* type_of_lcm_channel(const std::string& channel,
                                const std::string& prefix = "FRAMEWATCH_");

/// Why a payload on a channel that should carry `type` is none: another type of ours, too short,
/// damaged, or a fingerprint this program does not know - a type of a newer framewatch. One
/// sentence without its end.
std::string why_not(const std::string& type, std::span<const std::uint8_t> payload);

}  // namespace framewatch::drivers
