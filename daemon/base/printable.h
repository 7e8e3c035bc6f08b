#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

namespace framewatch::daemon {

/// A character of a text.
struct CodePoint {
  std::uint32_t value = 0;
  std::size_t bytes = 0;  ///< 0: what is there is no UTF-8
};

/// The first one of a text that is not empty.
CodePoint first_character(std::string_view text);

/// Text with the characters escaped that are markup in HTML: & < > and quotes.
std::string html_text(const std::string& text);

enum class Tone { good, doubtful, bad, strong };

/// Whether colours are for this stream: a terminal that has them (TERM is not "dumb"), and the
/// variable NO_COLOR is not set, or empty (https://no-color.org).
bool takes_colour(std::FILE* stream);

/// The text in the tone's colour when the stream takes colours, else the text. Its escapes are none
/// of printable()'s business: what comes from outside is made printable before.
std::string toned(Tone tone, const std::string& text, std::FILE* stream);

inline constexpr std::size_t kMaxPrinted = 4096;  ///< bytes

/// Text of unknown origin as one line that a terminal, a journal or an environment may have:
/// control characters (C0, DEL, C1, line separators, those that turn the direction of writing) and
/// bytes that are no UTF-8 as escapes ("\n", "\x1b", "\u202e"). Longer than `most` bytes, it is cut
/// and ends in "...". Text that has been through it is not changed again.
std::string printable(std::string_view text, std::size_t most = kMaxPrinted);

/// The same line by line and uncut, for text whose line breaks are the program's own.
std::string printable_lines(std::string_view text);

}  // namespace framewatch::daemon
