// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

namespace framewatch::daemon {

/// One character of a text.
struct CodePoint {
  std::uint32_t value = 0;
  std::size_t bytes = 0;  ///< 0 if the bytes are not UTF-8
};

/// Returns the first character of a nonempty text.
CodePoint first_character(std::string_view text);

/// Returns the text with the markup characters of HTML escaped: & < > and quotes.
std::string html_text(const std::string& text);

/// Returns printable(text) as a cell of CSV: in quotes if it holds a comma or a quote, with quotes
/// doubled.
std::string csv_text(std::string_view text);
/// Returns a number with nine digits for a cell of a CSV file; "" if it is not finite.
std::string csv_number(double value);

enum class Tone { good, doubtful, bad, strong };

/// Returns true if the stream is a terminal with colors: TERM is not "dumb", and NO_COLOR is unset
/// or empty (https://no-color.org).
bool takes_colour(std::FILE* stream);

/// Returns the text in the tone's color if the stream takes colors, else the text. Make text from
/// outside printable() first.
std::string toned(Tone tone, const std::string& text, std::FILE* stream);

inline constexpr std::size_t kMaxPrinted = 4096;  ///< bytes

/// Returns text of unknown origin as one line for a terminal, journal or environment variable.
/// Escapes control characters (C0, DEL, C1, line separators, changes of writing direction) and
/// bytes that are not UTF-8: "
/// ", "\x1b", "\u202e". Cuts texts longer than `most` bytes and appends "...". Does not change its
/// own results.
std::string printable(std::string_view text, std::size_t most = kMaxPrinted);

/// Applies printable() to each line without cutting. For text whose line breaks come from the
/// program.
std::string printable_lines(std::string_view text);

}  // namespace framewatch::daemon
