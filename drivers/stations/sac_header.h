#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace framewatch::drivers {

constexpr std::size_t kSacHeaderBytes = 632;

/// Where the header has what is read of it: words from 0, and texts of eight characters from 0.
enum class SacFloat : std::size_t { step_s = 0, begin_s = 5, azimuth_deg = 57, from_up_deg = 58 };
enum class SacInteger : std::size_t {
  year = 70,
  day_of_year = 71,
  hour = 72,
  minute = 73,
  second = 74,
  millisecond = 75,
  version = 76,
  points = 79,
  file_type = 85,
  quantity = 86,
  even = 105,
};
enum class SacText : std::size_t { station = 0, location = 3, channel = 20, network = 21 };

/// The header of a SAC file, version 6 or 7, of either order of bytes: 70 floats, 40 whole numbers,
/// 192 characters. What is not said is empty. SAC User Manual, "SAC data file format" (IRIS).
class SacHeader {
 public:
  /// Empty when the bytes are no such header.
  static std::optional<SacHeader> read(std::string_view bytes);

  bool other_byte_order() const { return swapped_; }
  /// The shortest decimal that the float is nearest to: 0.005, not 0.004999999888.
  std::optional<double> number(SacFloat field) const;
  std::optional<int> integer(SacInteger field) const;
  /// Without the blanks behind it.
  std::string text(SacText field) const;

 private:
  std::uint32_t word(std::size_t at) const;

  std::string bytes_;
  bool swapped_ = false;
};

inline bool is_sac_header(std::string_view bytes) {
  return SacHeader::read(bytes).has_value();
}

/// A value of four bytes in a file of that order.
float sac_value(const char* bytes, bool other_byte_order);

}  // namespace framewatch::drivers
