// SPDX-License-Identifier: MIT
#include "daemon/base/toml_document.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <utility>

#include <fmt/core.h>
#include <toml++/toml.h>

namespace framewatch::daemon {
namespace {

/// Returns the column of byte `at` in a UTF-8 text: the characters before it plus one.
int column_of(std::string_view line, std::size_t at) {
  return 1 + static_cast<int>(std::count_if(
                 line.begin(), line.begin() + static_cast<std::ptrdiff_t>(at),
                 [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

/// Returns where the line has one of the texts outside quotes and comments, or npos.
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

/// Returns "[channel]" for "cannot redefine existing table 'channel'".
std::string repeated_table(const std::string& description) {
  constexpr std::string_view kWords = "cannot redefine existing table '";
  const std::size_t at = description.find(kWords);
  if (at == std::string::npos) return {};
  const std::string name = description.substr(at + kWords.size());
  return name.substr(0, name.find('\''));
}

TextPlace place_of(const toml::source_region& region) {
  return {static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

TomlValue converted(const toml::node& node) {
  TomlValue out;
  out.place = place_of(node.source());
  if (const auto* table = node.as_table()) {
    for (const auto& [key, value] : *table)
      out.entries.push_back({std::string(key.str()), place_of(key.source()), converted(value)});
    std::stable_sort(out.entries.begin(), out.entries.end(), [](const auto& a, const auto& b) {
      return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
    });
  } else if (const auto* array = node.as_array()) {
    out.kind = TomlKind::array;
    for (const toml::node& item : *array) out.items.push_back(converted(item));
  } else if (const auto* text = node.as_string()) {
    out.kind = TomlKind::text;
    out.text = text->get();
  } else if (const auto* integer = node.as_integer()) {
    out.kind = TomlKind::integer;
    out.integer = integer->get();
    out.number = static_cast<double>(out.integer);
  } else if (const auto* number = node.as_floating_point()) {
    out.kind = TomlKind::number;
    out.number = number->get();
  } else if (const auto* boolean = node.as_boolean()) {
    out.kind = TomlKind::boolean;
    out.boolean = boolean->get();
  } else {
    out.kind = TomlKind::date;
  }
  return out;
}

/// Returns the begin and end of a line in the text.
std::pair<std::size_t, std::size_t> line_bounds(const std::string& text, int line) {
  std::size_t begin = 0;
  for (int i = 1; i < line && begin != std::string::npos; ++i) {
    begin = text.find('\n', begin);
    if (begin != std::string::npos) ++begin;
  }
  begin = std::min(begin, text.size());
  return {begin, std::min(text.find('\n', begin), text.size())};
}

/// Blanks the second of two equal keys, so that the rest keeps its places. A table header stays,
/// because its keys would otherwise move to the table above.
bool remove_duplicate(std::string& text, TextPlace& place) {
  const auto [begin, end] = line_bounds(text, place.line);
  const std::size_t first = text.find_first_not_of(" \t", begin);
  if (first >= end || text[first] == '[') return false;
  place.column = static_cast<int>(first - begin) + 1;
  std::fill(text.begin() + static_cast<std::ptrdiff_t>(first),
            text.begin() + static_cast<std::ptrdiff_t>(end), ' ');
  return true;
}

constexpr int kMaxDuplicates = 100;
constexpr int kMaxKeyParts = 8;  // times the 256 inline tables that the parser takes

/// Returns the length of the TOML string at `at`, or of its first line.
std::size_t string_length(std::string_view text, std::size_t at) {
  const char quote = text[at];
  const bool escapes = quote == '"';
  const std::string_view three(quote == '"' ? "\"\"\"" : "'''");
  if (text.substr(at, 3) == three) {
    std::size_t end = at + 3;
    while (end < text.size() && text.substr(end, 3) != three)
      end += escapes && text[end] == '\\' ? 2 : 1;
    end += 3;
    for (int more = 0; more < 2 && end < text.size() && text[end] == quote; ++more) ++end;
    return std::min(end, text.size()) - at;
  }
  std::size_t end = at + 1;
  while (end < text.size() && text[end] != quote && text[end] != '\n')
    end += escapes && text[end] == '\\' ? 2 : 1;
  return std::min(end + 1, text.size()) - at;
}

/// Returns the place of a key with more parts (a.b.c) than kMaxKeyParts. The parser recurses once
/// per part, on the stack.
std::optional<TextPlace> too_deep_key(std::string_view text) {
  TextPlace place{1, 1};
  int dots = 0;
  std::size_t line_begin = 0;
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    std::size_t length = 1;
    if (c == '"' || c == '\'') {
      length = string_length(text, at);
    } else if (c == '#') {
      length = std::min(text.find('\n', at), text.size()) - at;
    } else if (c == '.') {
      ++dots;
    } else if (c == '\n' || c == '=' || c == ',' || c == '[' || c == '{') {
      dots = 0;
    }
    if (dots >= kMaxKeyParts) {
      place.column = static_cast<int>(at - line_begin) + 1;
      return place;
    }
    for (const std::size_t end = at + length; at < end; ++at) {
      if (text[at] != '\n') continue;
      ++place.line;
      line_begin = at + 1;
    }
  }
  return std::nullopt;
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

std::vector<const TomlValue*> tables_of(const TomlValue& table, std::string_view name,
                                        std::vector<TextProblem>& problems) {
  std::vector<const TomlValue*> out;
  const TomlEntry* entry = table.find(name);
  if (!entry) return out;
  const std::vector<TomlValue>& items = entry->value.items;
  const bool every = std::all_of(items.begin(), items.end(),
                                 [](const TomlValue& v) { return v.kind == TomlKind::table; });
  if (entry->value.kind != TomlKind::array || !every) {
    problems.push_back(
        {entry->place, std::string(name) + ": write [[" + std::string(name) + "]], once for each"});
    return out;
  }
  for (const TomlValue& item : items) out.push_back(&item);
  return out;
}

std::optional<TomlValue> parse_toml(std::string text, std::vector<TextProblem>& problems) {
  if (const auto place = too_deep_key(text)) {
    problems.push_back({*place, fmt::format("a key has at most {} parts", kMaxKeyParts)});
    return std::nullopt;
  }
  for (int removed = 0; removed < kMaxDuplicates; ++removed) {
    try {
      return converted(toml::parse(text));
    } catch (const toml::parse_error& error) {
      TextProblem problem{place_of(error.source()), std::string(error.description())};
      const std::size_t reason = problem.message.find("cannot redefine existing");
      const bool duplicate = reason != std::string::npos;
      if (duplicate) problem.message = "duplicate: " + problem.message.substr(reason);
      const auto [begin, end] = line_bounds(text, problem.place.line);
      problem.message = toml_advice(
          problem.message, std::string_view(text).substr(begin, end - begin), problem.place.column);
      // The parser stops at its first error. Blanking a repeated key shows the errors after it.
      const bool go_on = duplicate && remove_duplicate(text, problem.place);
      // Blanking removes only the first line of a value, so later errors may be caused by it.
      if (duplicate || removed == 0) problems.push_back(problem);
      if (!go_on) break;
    }
  }
  return std::nullopt;
}

const TomlEntry* TomlValue::find(std::string_view key) const {
  const auto at = std::find_if(entries.begin(), entries.end(),
                               [&](const TomlEntry& entry) { return entry.key == key; });
  return at == entries.end() ? nullptr : &*at;
}

std::string TomlValue::described() const {
  switch (kind) {
    case TomlKind::text:
      return "the text \"" + text + "\"";
    case TomlKind::integer:
      return std::to_string(integer);
    case TomlKind::number:
      return fmt::format("{:g}", number);
    case TomlKind::boolean:
      return boolean ? "true" : "false";
    case TomlKind::array:
      return fmt::format("a list of {}", items.size());
    case TomlKind::table:
      return "a table";
    case TomlKind::date:
      return "a date or time";
  }
  return "";
}

}  // namespace framewatch::daemon
