#include "drivers/lcm/message_check.h"

#include <algorithm>
#include <vector>

#include <framewatch/message_layouts.hpp>

namespace framewatch::drivers {
namespace {

std::uint64_t big_endian(std::span<const std::uint8_t> bytes) {
  std::uint64_t value = 0;
  for (const std::uint8_t byte : bytes) value = value << 8 | byte;
  return value;
}

/// Reads over a payload's fields without ever leaving it.
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
    const std::uint64_t read = big_endian(rest_.first(4));
    if (read > INT32_MAX) return false;
    value = read;
    return skip(4);
  }
  bool string() {
    std::size_t bytes = 0;  // with its closing zero
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

}  // namespace

std::optional<std::int64_t> fingerprint(std::span<const std::uint8_t> payload) {
  if (payload.size() < 8) return std::nullopt;
  return static_cast<std::int64_t>(big_endian(payload.first(8)));
}

bool is_well_formed(std::span<const std::uint8_t> payload, std::int64_t wanted) {
  if (fingerprint(payload) != wanted) return false;
  const auto layout = std::ranges::find_if(
      kMessageLayouts,
      [wanted](const MessageLayout& candidate) { return candidate.fingerprint() == wanted; });
  return layout != std::end(kMessageLayouts) && has_layout(payload, layout->fields);
}

}  // namespace framewatch::drivers
