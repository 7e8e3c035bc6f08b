// SPDX-License-Identifier: MIT
#include "drivers/lcm/message_check.h"
#include "drivers/files/big_endian.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include <framewatch/message_layouts.hpp>

#include <fmt/core.h>

namespace framewatch::drivers {
namespace {

/// Steps through the fields of a payload. Each function returns false at the end of the payload.
class PayloadReader {
 public:
  explicit PayloadReader(std::span<const std::uint8_t> payload) : rest_(payload) {}

  bool skip(std::size_t bytes) {
    if (bytes > rest_.size()) return false;
    rest_ = rest_.subspan(bytes);
    return true;
  }
  bool length(std::size_t& value) {
    if (rest_.size() < 4) return false;
    const auto read = big_endian<std::uint32_t>(rest_.data());
    if (read > INT32_MAX) return false;
    value = read;
    return skip(4);
  }
  bool string() {
    std::size_t bytes = 0;  // including the closing zero
    return length(bytes) && bytes >= 1 && bytes <= rest_.size() && rest_[bytes - 1] == 0 &&
           skip(bytes);
  }
  bool at_end() const { return rest_.empty(); }

 private:
  std::span<const std::uint8_t> rest_;
};

bool has_layout(std::span<const std::uint8_t> payload, std::span<const FieldLayout> fields) {
  PayloadReader reader(payload);
  if (!reader.skip(8)) return false;  // the fingerprint
  std::vector<std::size_t> lengths(fields.size());
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const FieldLayout& field = fields[i];
    const std::size_t elements = field.length_field < 0
                                     ? static_cast<std::size_t>(field.elements)
                                     : lengths[static_cast<std::size_t>(field.length_field)];
    if (field.is_length) {
      if (!reader.length(lengths[i])) return false;
    } else if (field.bytes > 0) {
      if (!reader.skip(static_cast<std::size_t>(field.bytes) * elements)) return false;
    } else {
      for (std::size_t k = 0; k < elements; ++k)
        if (!reader.string()) return false;
    }
  }
  return reader.at_end();
}

constexpr std::string_view kDefaultPrefix = "FRAMEWATCH_";  // of LCM channels in lcmtypes/*.lcm

bool matches(std::string_view lcm_channel, std::string_view pattern) {
  if (pattern.ends_with('*')) return lcm_channel.starts_with(pattern.substr(0, pattern.size() - 1));
  if (pattern.starts_with('*'))  // * stands for at least one character
    return lcm_channel.size() >= pattern.size() && lcm_channel.ends_with(pattern.substr(1));
  return lcm_channel == pattern;
}

}  // namespace

std::optional<std::int64_t> fingerprint(std::span<const std::uint8_t> payload) {
  if (payload.size() < 8) return std::nullopt;
  return big_endian<std::int64_t>(payload.data());
}

bool is_well_formed(std::span<const std::uint8_t> payload, std::int64_t wanted) {
  if (fingerprint(payload) != wanted) return false;
  const auto layout = std::ranges::find_if(
      kMessageLayouts,
      [wanted](const MessageLayout& candidate) { return candidate.fingerprint() == wanted; });
  return layout != std::end(kMessageLayouts) && has_layout(payload, layout->fields);
}

const char* known_type(std::int64_t fingerprint) {
  for (const MessageLayout& layout : kMessageLayouts)
    if (layout.fingerprint() == fingerprint) return layout.type;
  return nullptr;
}

const char* type_of_lcm_channel(const std::string& lcm_channel, const std::string& prefix) {
  // First tables, which alone end in _CHANNELS, then channels of sensors, then those of framewatch.
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
  if (!found) return fmt::format("{} bytes are too few for {}", payload.size(), type);
  const char* known = known_type(*found);
  if (known != nullptr && known == type)
    return fmt::format("a damaged {}: its lengths do not fit its size", type);
  if (known != nullptr) return fmt::format("{} where {} belongs", known, type);
  return fmt::format(
      "not the {0} of framewatch {1} (fingerprint {2:016x}): the bytes are damaged or foreign, or "
      "a "
      "newer framewatch wrote them with a newer {0}; read them with that version",
      type, FRAMEWATCH_VERSION, static_cast<std::uint64_t>(*found));
}

}  // namespace framewatch::drivers
