#include "daemon/base/toml_advice.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <utility>

namespace framewatch::daemon {
namespace {

/// Characters before the byte `at` of a text in UTF-8, plus one.
int column_of(std::string_view line, std::size_t at) {
  return 1 + static_cast<int>(std::count_if(
                 line.begin(), line.begin() + static_cast<std::ptrdiff_t>(at),
                 [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

/// Where the line has one of the texts outside of quotes and comments; npos: nowhere.
template <std::size_t Size>
std::size_t find_bare(std::string_view line, const std::array<std::string_view, Size>& texts) {
  char quote = 0;
  for (std::size_t at = 0; at < line.size(); ++at) {
    const char c = line[at];
    if (quote != 0) {
      if (c == '\\' && quote == '"')
        ++at;
      else if (c == quote)
        quote = 0;
      continue;
    }
    if (c == '#') break;
    if (c == '"' || c == '\'') quote = c;
    for (const std::string_view text : texts)
      if (line.substr(at).starts_with(text)) return at;
  }
  return std::string_view::npos;
}

std::string_view without_spaces(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

std::string_view value_in(std::string_view line) {
  const std::size_t equals = line.find('=');
  return equals == std::string_view::npos ? std::string_view()
                                          : without_spaces(line.substr(equals + 1));
}

bool is_decimal_comma(std::string_view value) {
  const std::size_t comma = value.find(',');
  const auto digit = [&](std::size_t at) {
    return at < value.size() && std::isdigit(static_cast<unsigned char>(value[at])) != 0;
  };
  return comma != std::string_view::npos && comma > 0 && digit(comma - 1) && digit(comma + 1) &&
         value.find('[') == std::string_view::npos;
}

bool is_boolean_otherwise(std::string_view value) {
  std::string lower(value);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower == "true" || lower == "false" || lower == "yes" || lower == "no" || lower == "on" ||
         lower == "off";
}

/// "[channel]" of "cannot redefine existing table 'channel'".
std::string repeated_table(const std::string& description) {
  constexpr std::string_view kWords = "cannot redefine existing table '";
  const std::size_t at = description.find(kWords);
  if (at == std::string::npos) return {};
  const std::string name = description.substr(at + kWords.size());
  return name.substr(0, name.find('\''));
}

}  // namespace

std::string toml_advice(const std::string& description, std::string_view line, int& column) {
  if (const std::string table = repeated_table(description); !table.empty())
    return "duplicate: the section [" + table +
           "] was there before: where there are several, write [[" + table +
           "]], in double brackets, above each";
  constexpr std::array<std::string_view, 4> kCurly{"\u201c", "\u201d", "\u2018", "\u2019"};
  if (const std::size_t at = find_bare(line, kCurly); at != std::string_view::npos) {
    column = column_of(line, at);
    return "a curly quote, as word processors make them: write \" on both sides of a text";
  }
  const auto says = [&](std::string_view words) {
    return description.find(words) != std::string::npos;
  };
  const std::string_view value = value_in(line), whole = without_spaces(line);
  const bool has_equals = line.find('=') != std::string_view::npos;
  if (has_equals && value.empty()) return "nothing stands after the =";
  if (says("saw ','") && is_decimal_comma(value))
    return "a number has a point, not a comma: write 1.5 for 1,5";
  if (is_boolean_otherwise(value)) return "write true or false, in lower case";
  if (says("saw ';'") || says("saw '/'"))
    return "a remark begins with #, and nothing else follows a value";
  if (says("expected ']'") && whole.starts_with('[') && !whole.ends_with(']'))
    return "the ] is missing that ends the section's name";
  if (says("expected '='") && !has_equals && !whole.starts_with('['))
    return "neither a [section] nor a line of the form key = value";
  if (value.starts_with('"') && std::count(value.begin(), value.end(), '"') == 1)
    return "the \" is missing that ends the text";
  if (!value.empty() && std::isalpha(static_cast<unsigned char>(value.front())) != 0)
    return "a text stands between quotes: \"" + std::string(value) + "\"";
  return description;
}

}  // namespace framewatch::daemon
