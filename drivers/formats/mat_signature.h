#pragma once

#include <cstddef>
#include <string_view>

namespace framewatch::drivers {

/// Bytes of a MATLAB file that tell its level.
inline constexpr std::size_t kMatHeaderBytes = 128;

/// Whether a file that begins so is MATLAB's, of level 5 (version 0x0100) or 7.3 (0x0200).
inline bool is_mat_signature(std::string_view head) {
  if (head.size() < kMatHeaderBytes || !head.starts_with("MATLAB ")) return false;
  const std::string_view version = head.substr(124, 2), order = head.substr(126, 2);
  const char low = order == "IM" ? version[0] : version[1];
  const char high = order == "IM" ? version[1] : version[0];
  return (order == "IM" || order == "MI") && low == 0 && (high == 1 || high == 2);
}

}  // namespace framewatch::drivers
