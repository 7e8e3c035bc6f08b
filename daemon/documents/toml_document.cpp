#include "daemon/documents/toml_document.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <fmt/core.h>
#include <toml++/toml.h>

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
  for (int removed = 0; removed < kMaxDuplicates; ++removed) {
    try {
      return converted(toml::parse(text));
    } catch (const toml::parse_error& error) {
      TextProblem problem{place_of(error.source()), std::string(error.description())};
      const std::size_t reason = problem.message.find("cannot redefine existing");
      const bool duplicate = reason != std::string::npos;
      if (duplicate) problem.message = "duplicate: " + problem.message.substr(reason);
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
