// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace framewatch::drivers {

/// Walks through the text of a DBC file word by word. A function that does not find what it looks
/// for consumes only the space before it: blanks, line ends and remarks after //.
class DbcScanner {
 public:
  explicit DbcScanner(std::string_view text) : text_(text) {}

  bool at_end() const { return at_ >= text_.size(); }
  std::int64_t line() const { return line_; }
  /// Returns the rest of this line, for messages.
  std::string_view rest_of_line() const;

  void skip_space();
  void skip_line();
  /// Skips to after the next ';' outside quotes. Returns false at the end of the file.
  bool skip_statement();

  /// Reads a name of letters, digits and _ that does not begin with a digit. Returns an empty text
  /// when something else stands here.
  std::string_view word();
  /// Returns what word() would return, without consuming it.
  std::string_view peek_word();
  /// Reads a character. Returns false for another one.
  bool symbol(char wanted);
  std::optional<std::uint64_t> natural();
  std::optional<double> number();
  /// Reads a text in quotes, which may span lines. Returns nullopt when the next character is not a
  /// quote, or the text does not end.
  std::optional<std::string> quoted();

 private:
  char here() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  void step() {
    if (here() == '\n') ++line_;
    ++at_;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::int64_t line_ = 1;
};

}  // namespace framewatch::drivers
