// SPDX-License-Identifier: MIT
#include "daemon/config/keys/section.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <utility>

#include <fmt/core.h>

#include "daemon/config/keys/suggest.h"

namespace framewatch::daemon {
namespace {

struct GridReading {
  std::vector<double> values;  ///< flattened, last index fastest
  TextPlace place;             ///< place of the problem
  std::string problem;         ///< empty when the values are good
};

int depth(const TomlValue& value) {
  if (value.kind != TomlKind::array) return 0;
  int deepest = 0;
  for (const TomlValue& item : value.items) deepest = std::max(deepest, depth(item));
  return 1 + deepest;
}

/// Returns the sizes that the file's nesting must have: drops sizes of 1, last first, while there
/// are more dimensions than nesting levels.
std::vector<int> sizes_for_depth(std::vector<int> sizes, int nesting) {
  while (static_cast<int>(sizes.size()) > nesting) {
    const auto one = std::find(sizes.rbegin(), sizes.rend(), 1);
    if (one == sizes.rend()) break;
    sizes.erase(std::next(one).base());
  }
  return sizes;
}

void read_level(const TomlValue& value, const std::vector<int>& sizes, std::size_t level,
                GridReading& out) {
  if (!out.problem.empty()) return;
  const bool is_list = value.kind == TomlKind::array;
  if (level == sizes.size()) {
    if (is_list) {
      out.place = value.place;
      out.problem = "here a number is expected, found a list";
    } else {
      out.values.push_back(value.number);
    }
    return;
  }
  const auto wanted = static_cast<std::size_t>(sizes[level]);
  if (!is_list || value.items.size() != wanted) {
    out.place = value.place;
    out.problem = fmt::format("here a list of {} is expected, found {}", wanted,
                              is_list ? fmt::format("{}", value.items.size()) : "a number");
    return;
  }
  for (const TomlValue& item : value.items) read_level(item, sizes, level + 1, out);
}

/// Reads nested lists of numbers of these sizes; a number alone stands for all. The nesting may
/// leave out dimensions of size 1: [story][frame] is good for a plane building's [story][y][x].
GridReading read_grid(const TomlValue& value, const std::vector<int>& sizes) {
  GridReading out;
  if (value.kind != TomlKind::array) {
    std::size_t count = 1;
    for (const int size : sizes) count *= static_cast<std::size_t>(size);
    out.values.assign(count, value.number);
    return out;
  }
  read_level(value, sizes_for_depth(sizes, depth(value)), 0, out);
  if (!out.problem.empty()) out.values.clear();
  return out;
}

/// Returns sizes as "2 x 3 x 3".
std::string size_text(const std::vector<int>& sizes) {
  std::string out;
  for (const int size : sizes) out += fmt::format("{}{}", out.empty() ? "" : " x ", size);
  return out;
}

/// Returns the numbers of a TOML list such as "[1.0, 2.5]".
std::vector<double> numbers_in(const std::string& list) {
  std::vector<double> out;
  const char* at = list.c_str();
  while (*at != '\0') {
    char* end = nullptr;
    const double value = std::strtod(at, &end);
    if (end == at) {
      ++at;
      continue;
    }
    out.push_back(value);
    at = end;
  }
  return out;
}

const TomlValue* table_in(const TomlValue& document, std::string_view section) {
  const TomlEntry* entry = document.find(section);
  return entry ? &entry->value : nullptr;
}

}  // namespace

ConfigSection::ConfigSection(std::string_view section, std::string label, const TomlValue* table,
                             TextPlace where, std::vector<TextProblem>& problems)
    : section_(section),
      label_(std::move(label)),
      table_(table),
      where_(table ? table->place : where),
      problems_(&problems) {
  if (table_ && table_->kind != TomlKind::table) {
    problems_->push_back(
        {where_, fmt::format("{}: expected a table, got {}", label_, table_->described())});
    table_ = nullptr;
    for (const Option& o : options())
      if (o.section == section_) bad_.insert(std::string(o.key));
    return;
  }
  check_keys();
  for (const Option& o : options()) {
    if (o.section != section_) continue;
    const TomlValue* found = value(o.key);
    if (found) check_value(o, *found);
    if (!found && o.required)
      report(o, where_, fmt::format("is missing, it has no default: {}", expected(o)));
  }
}

ConfigSection::ConfigSection(std::string_view section, const TomlValue& document,
                             std::vector<TextProblem>& problems)
    : ConfigSection(section, std::string(section), table_in(document, section), {1, 1}, problems) {}

bool ConfigSection::is_subsection(std::string_view key) const {
  const std::string name = fmt::format("{}.{}", section_, key);
  const auto all = options();
  return std::any_of(all.begin(), all.end(), [&](const Option& o) { return o.section == name; });
}

void ConfigSection::check_keys() {
  if (!table_) return;
  for (const TomlEntry& entry : table_->entries) {
    if (find_option(section_, entry.key) || is_subsection(entry.key)) continue;
    problems_->push_back({entry.place, fmt::format("{}: unknown key {}: {}", label_, entry.key,
                                                   advice_on_unknown_key(section_, entry.key))});
  }
}

void ConfigSection::check_value(const Option& o, const TomlValue& value) {
  const auto wrong_type = [&] {
    report(o, value.place, fmt::format("expected {}, got {}", expected(o), value.described()));
  };
  switch (o.type) {
    case OptionType::text:
      if (value.kind != TomlKind::text) wrong_type();
      return;
    case OptionType::choice: {
      if (value.kind != TomlKind::text) return wrong_type();
      const std::vector<std::string> known = choices(o);
      if (std::find(known.begin(), known.end(), value.text) != known.end()) return;
      report(o, value.place,
             fmt::format("must be {}, got \"{}\"{}", constraint(o), value.text,
                         did_you_mean(value.text, known, "\"")));
      return;
    }
    case OptionType::integer:
      if (value.kind != TomlKind::integer) return wrong_type();
      return check_number(o, value);
    case OptionType::number:
      if (value.kind != TomlKind::integer && value.kind != TomlKind::number) return wrong_type();
      return check_number(o, value);
    case OptionType::boolean:
      if (value.kind != TomlKind::boolean) wrong_type();
      return;
    case OptionType::texts:
      if (value.kind != TomlKind::array) return wrong_type();
      for (const TomlValue& item : value.items)
        if (item.kind != TomlKind::text)
          report(o, item.place, fmt::format("expected a text in quotes, got {}", item.described()));
      return;
    case OptionType::grid:
      return check_leaves(o, value);
    case OptionType::table:
      if (value.kind != TomlKind::table) wrong_type();
      return;
  }
}

void ConfigSection::check_number(const Option& o, const TomlValue& value) {
  const double v = value.number;
  const bool inside = std::isfinite(v) && v >= o.range.min && v <= o.range.max &&
                      (v > o.range.min || !o.range.above_min);
  if (!inside)
    report(o, value.place, fmt::format("must be {}, got {}", constraint(o), value.described()));
}

void ConfigSection::check_leaves(const Option& o, const TomlValue& value) {
  if (value.kind == TomlKind::array) {
    for (const TomlValue& item : value.items) check_leaves(o, item);
  } else if (value.kind == TomlKind::integer || value.kind == TomlKind::number) {
    check_number(o, value);
  } else {
    report(o, value.place, fmt::format("expected {}, got {}", expected(o), value.described()));
  }
}

void ConfigSection::report(const Option& o, TextPlace place, const std::string& message) {
  bad_.insert(std::string(o.key));
  problems_->push_back({place, fmt::format("{}.{}: {}", label_, o.key, message)});
}

void ConfigSection::problem(std::string_view key, const std::string& message) {
  const TomlValue* found = key.empty() ? nullptr : value(key);
  if (key.empty()) {
    problems_->push_back({where_, fmt::format("{}: {}", label_, message)});
  } else {
    report(option(key), found ? found->place : where_, message);
  }
}

const Option& ConfigSection::option(std::string_view key) const {
  const Option* found = find_option(section_, key);
  assert(found && "the option table has every key the program asks for");
  return *found;
}

const TomlValue* ConfigSection::value(std::string_view key) const {
  const TomlEntry* entry = table_ ? table_->find(key) : nullptr;
  return entry ? &entry->value : nullptr;
}

bool ConfigSection::given(std::string_view key) const {
  return value(key) && good(key);
}

std::string ConfigSection::default_of(std::string_view key) const {
  const Option& o = option(key);
  return paper_defaults_ && !o.paper_default.empty() ? o.paper_default : o.default_value;
}

double ConfigSection::number(std::string_view key) const {
  if (given(key)) return value(key)->number;
  return std::strtod(default_of(key).c_str(), nullptr);
}

int ConfigSection::integer(std::string_view key) const {
  if (given(key)) return static_cast<int>(value(key)->integer);
  return static_cast<int>(number(key));
}

bool ConfigSection::boolean(std::string_view key) const {
  return given(key) ? value(key)->boolean : option(key).default_value == "true";
}

std::string ConfigSection::text(std::string_view key) const {
  if (given(key)) return value(key)->text;
  std::string quoted = default_of(key);
  std::erase(quoted, '"');
  return quoted;
}

std::vector<std::string> ConfigSection::texts(std::string_view key) const {
  std::vector<std::string> out;
  if (given(key))
    for (const TomlValue& item : value(key)->items) out.push_back(item.text);
  return out;
}

std::vector<double> ConfigSection::grid(std::string_view key, const std::vector<int>& sizes) {
  if (!good(key)) return {};
  TomlValue empty_list;
  empty_list.kind = TomlKind::array;
  const TomlValue& source = given(key) ? *value(key) : empty_list;
  const GridReading reading = read_grid(source, sizes);
  if (reading.problem.empty()) return reading.values;
  report(option(key), given(key) ? reading.place : where_,
         fmt::format("{} is {}: {}", option(key).shape, size_text(sizes), reading.problem));
  return {};
}

std::vector<double> ConfigSection::list(std::string_view key) {
  if (!given(key)) return good(key) ? numbers_in(default_of(key)) : std::vector<double>{};
  const TomlValue& items = *value(key);
  const std::size_t count = items.kind == TomlKind::array ? items.items.size() : 1;
  return grid(key, {static_cast<int>(count)});
}

void ConfigSection::store(const void* owner, void* settings) {
  for (const Option& o : options()) {
    if (o.section != section_ || o.target.owner != owner) continue;
    KeyValue found;
    switch (o.type) {
      case OptionType::text:
        found.text = text(o.key);
        break;
      case OptionType::choice: {
        const std::vector<std::string> known = choices(o);
        const auto at = std::find(known.begin(), known.end(), text(o.key));
        if (at == known.end()) continue;
        found.integer = static_cast<int>(at - known.begin());
        break;
      }
      case OptionType::integer:
        found.integer = integer(o.key);
        [[fallthrough]];
      case OptionType::number:
        found.number = number(o.key);
        if (o.target.converted != nullptr) found.number = o.target.converted(found.number);
        break;
      case OptionType::boolean:
        found.boolean = boolean(o.key);
        break;
      case OptionType::texts:
        if (!given(o.key)) continue;  // the field has its default
        found.texts = texts(o.key);
        break;
      case OptionType::grid:
        found.list = list(o.key);
        if (!good(o.key)) continue;
        break;
      case OptionType::table:
        continue;
    }
    o.target.store(found, settings);
  }
}

}  // namespace framewatch::daemon
