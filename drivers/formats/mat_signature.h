#pragma once

#include <cstddef>
#include <string_view>

namespace framewatch::drivers {

/// Bytes of a MATLAB file that tell its level.
inline constexpr std::size_t kMatHeaderBytes = 128;

enum class MatLevel { none, level_5, level_7_3 };

/// Of a file that begins so. MATLAB says which byte comes first, and its version: 0x0100, 0x0200.
inline MatLevel mat_level(std::string_view head) {
  if (head.size() < kMatHeaderBytes || !head.starts_with("MATLAB ")) return MatLevel::none;
  const std::string_view version = head.substr(124, 2), order = head.substr(126, 2);
  if ((order != "IM" && order != "MI") || version[order == "IM" ? 0 : 1] != 0)
    return MatLevel::none;
  const char high = version[order == "IM" ? 1 : 0];
  return high == 1 ? MatLevel::level_5 : high == 2 ? MatLevel::level_7_3 : MatLevel::none;
}

}  // namespace framewatch::drivers
