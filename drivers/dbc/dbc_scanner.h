#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace framewatch::drivers {

/// Walks through the text of a DBC file word by word. Nothing is consumed by what does not match.
class DbcScanner {
 public:
  explicit DbcScanner(std::string_view text) : text_(text) {}

  bool at_end() const { return at_ >= text_.size(); }
  std::int64_t line() const { return line_; }
  /// The rest of this line, for messages.
  std::string_view rest_of_line() const;

  void skip_space();   ///< blanks and line ends
  void skip_blanks();  ///< within the line
  void skip_line();
  /// To after the next ';' that is not in a quoted text. False at the end of the file.
  bool skip_statement();

  /// A name: letters, digits, _, not beginning with a digit. Empty when there is none.
  std::string_view word();
  /// The word that word() would give.
  std::string_view peek_word();
  bool symbol(char wanted);  ///< after blanks
  std::optional<std::uint64_t> natural();
  std::optional<double> number();
  /// A text in quotes, which may go over lines.
  std::optional<std::string> quoted();

 private:
  char here() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  void step();

  std::string_view text_;
  std::size_t at_ = 0;
  std::int64_t line_ = 1;
};

}  // namespace framewatch::drivers
