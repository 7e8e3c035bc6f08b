// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace framewatch::drivers {

/// Bytes at the start of a file that unread_format() needs.
inline constexpr std::size_t kHeadBytes = 2048;

/// Returns what a file that begins with `head` is and how to convert it, if it has a known format
/// that framewatch does not read: "is a NumPy array (.npy), which is not supported: ...". Returns
/// an empty string for any other file.
std::string unread_format(std::string_view head);

}  // namespace framewatch::drivers
