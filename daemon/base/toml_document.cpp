#include "daemon/base/toml_document.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <fmt/core.h>
#include <toml++/toml.h>

#include "daemon/base/toml_advice.h"

namespace framewatch::daemon {
namespace {

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

/// The line's begin and end in the text.
std::pair<std::size_t, std::size_t> line_bounds(const std::string& text, int line) {
  std::size_t begin = 0;
  for (int i = 1; i < line && begin != std::string::npos; ++i) {
    begin = text.find('\n', begin);
    if (begin != std::string::npos) ++begin;
  }
  begin = std::min(begin, text.size());
  return {begin, std::min(text.find('\n', begin), text.size())};
}

/// Blanks the second of two equal keys, so that the rest of the text keeps its places. A table
/// header cannot go: its keys would fall to the table above.
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

/// Length of the string of TOML that begins at `at`, of its first line when it has several.
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

/// Where a key has more parts (a.b.c) than kMaxKeyParts: reading nests as deep, on the stack.
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
      // The parser stops at its first error; a key given twice need not hide what follows it.
      const bool go_on = duplicate && remove_duplicate(text, problem.place);
      // A value over several lines loses its first only: what the parser says then is our doing.
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
