#include "drivers/lcm/message_types.h"

#include <string_view>

#include <framewatch/message_layouts.hpp>

#include <fmt/core.h>

#include "drivers/lcm/message_check.h"

namespace framewatch::drivers {
namespace {

constexpr std::string_view kDefaultPrefix = "FRAMEWATCH_";  // of the LCM channels in lcmtypes/*.lcm

bool matches(std::string_view lcm_channel, std::string_view pattern) {
  if (pattern.ends_with('*')) return lcm_channel.starts_with(pattern.substr(0, pattern.size() - 1));
  if (pattern.starts_with('*'))  // stands for one character at least
    return lcm_channel.size() >= pattern.size() && lcm_channel.ends_with(pattern.substr(1));
  return lcm_channel == pattern;
}

}  // namespace

const char* known_type(std::int64_t fingerprint) {
  for (const MessageLayout& layout : kMessageLayouts)
    if (layout.fingerprint() == fingerprint) return layout.type;
  return nullptr;
}

const char* type_of_lcm_channel(const std::string& lcm_channel, const std::string& prefix) {
  // A table's name ends as no other does; then the channels of sensors, then those of framewatch.
  for (const MessageLayout& layout : kMessageLayouts)
    if (layout.lcm_channel.starts_with('*') && matches(lcm_channel, layout.lcm_channel))
      return layout.type;
  for (const MessageLayout& layout : kMessageLayouts)
    if (!layout.lcm_channel.starts_with(kDefaultPrefix) && matches(lcm_channel, layout.lcm_channel))
      return layout.type;
  if (!lcm_channel.starts_with(prefix)) return nullptr;
  const std::string_view rest = std::string_view(lcm_channel).substr(prefix.size());
  for (const MessageLayout& layout : kMessageLayouts)
    if (layout.lcm_channel.starts_with(kDefaultPrefix) &&
        matches(rest, layout.lcm_channel.substr(kDefaultPrefix.size())))
      return layout.type;
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
