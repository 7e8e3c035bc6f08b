#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace framewatch::drivers {

constexpr std::size_t kSacHeaderBytes = 632;

/// The header of a SAC file, version 6 or 7, of either order of bytes: 70 floats, 40 whole numbers,
/// 192 characters. What is not said is empty. SAC User Manual, "SAC data file format" (IRIS).
class SacHeader {
 public:
  /// Empty when the bytes are no such header.
  static std::optional<SacHeader> read(std::string_view bytes);

  bool other_byte_order() const { return swapped_; }
  /// By the word's place from 0: floats 0 to 69, whole numbers 70 to 109. A float is the shortest
  /// decimal that it is the nearest float to: 0.005, not 0.004999999888.
  std::optional<double> number(std::size_t word) const;
  std::optional<int> integer(std::size_t word) const;
  /// Eight characters, by their place from 0, without the blanks behind them; 0 is the station.
  std::string text(std::size_t place) const;

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
