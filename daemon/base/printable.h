#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace framewatch::daemon {

inline constexpr std::size_t kMaxPrinted = 4096;  ///< bytes

/// Text of unknown origin as one line that a terminal, a journal or an environment may have:
/// control characters (C0, DEL, C1, line separators, those that turn the direction of writing) and
/// bytes that are no UTF-8 as escapes ("\n", "\x1b", "\u202e"). Longer than `most` bytes, it is cut
/// and ends in "...". Text that has been through it is not changed again.
std::string printable(std::string_view text, std::size_t most = kMaxPrinted);

/// The same line by line and uncut, for text whose line breaks are the program's own.
std::string printable_lines(std::string_view text);

}  // namespace framewatch::daemon
