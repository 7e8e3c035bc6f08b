#include "drivers/stations/sac_header.h"

#include <bit>
#include <cmath>
#include <cstring>

#include <fmt/core.h>

#include "drivers/files/number_text.h"

namespace framewatch::drivers {
namespace {

constexpr std::size_t kWordBytes = 4, kTextBegin = 440, kTextBytes = 8;
constexpr int kSacUndefined = -12345;

std::uint32_t word_at(const char* bytes, bool swapped) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes, sizeof word);
  return swapped ? __builtin_bswap32(word) : word;
}

}  // namespace

float sac_value(const char* bytes, bool other_byte_order) {
  return std::bit_cast<float>(word_at(bytes, other_byte_order));
}

std::optional<SacHeader> SacHeader::read(std::string_view bytes) {
  if (bytes.size() < kSacHeaderBytes) return std::nullopt;
  SacHeader header;
  header.bytes_ = bytes.substr(0, kSacHeaderBytes);
  for (const bool swapped : {false, true}) {
    header.swapped_ = swapped;
    const auto version = header.integer(SacInteger::version),
               points = header.integer(SacInteger::points);
    if ((version == 6 || version == 7) && points > 0 && header.number(SacFloat::step_s) > 0)
      return header;
  }
  return std::nullopt;
}

std::uint32_t SacHeader::word(std::size_t at) const {
  return word_at(bytes_.data() + at * kWordBytes, swapped_);
}

std::optional<double> SacHeader::number(SacFloat field) const {
  const auto value = std::bit_cast<float>(word(static_cast<std::size_t>(field)));
  if (!std::isfinite(value) || value == static_cast<float>(kSacUndefined)) return std::nullopt;
  return parse_number(fmt::format("{}", value));
}

std::optional<int> SacHeader::integer(SacInteger field) const {
  const auto value = std::bit_cast<std::int32_t>(word(static_cast<std::size_t>(field)));
  return value == kSacUndefined ? std::nullopt : std::optional<int>(value);
}

std::string SacHeader::text(SacText field) const {
  std::string_view text(bytes_);
  text = text.substr(kTextBegin + static_cast<std::size_t>(field) * kTextBytes, kTextBytes);
  text = trimmed(text.substr(0, text.find('\0')));
  return std::string(text.starts_with("-12345") ? std::string_view() : text);
}

}  // namespace framewatch::drivers
