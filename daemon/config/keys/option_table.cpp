// SPDX-License-Identifier: MIT
#include "daemon/config/keys/option_table.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

namespace framewatch::daemon {
namespace {

using enum OptionType;

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// Returns the shortest text of a number: "0.3", "60", "1e-6".
std::string number_text(double value) {
  std::string out = fmt::format("{}", value);
  const std::size_t padded = out.find("e-0");
  if (padded != std::string::npos) out.erase(padded + 2, 1);
  return out;
}

template <class Items, class Text>
std::string list_text(const Items& items, Text text_of) {
  std::string out;
  for (const auto& item : items) out += (out.empty() ? "" : ", ") + text_of(item);
  return "[" + out + "]";
}

std::string in_quotes(const std::string& words) {
  return "\"" + words + "\"";
}

/// Returns the initial value of the target's field in TOML, in the key's unit. Empty for an empty
/// text, which stands for a key that is not set.
std::string default_in_field(const Option& option) {
  const KeyValue value = option.target.initial(option.type);
  const auto converted = option.target.converted;
  switch (option.type) {
    case text:
      return value.text.empty() ? "" : in_quotes(value.text);
    case choice:
      return in_quotes(choices(option).at(static_cast<std::size_t>(value.integer)));
    case integer:
    case number:
      return number_text(converted ? value.number / converted(1) : value.number);
    case boolean:
      return value.boolean ? "true" : "false";
    case texts:
      return list_text(value.texts, in_quotes);
    case grid:
      return list_text(value.list, number_text);
    case table:
      return "";
  }
  return "";
}

/// Sets the fields of a row that follow from its section and its other fields.
Option completed(Option o, const OptionSection& of) {
  o.section = of.section;
  if (!o.reload) o.reload = of.reload;
  if (!o.choices.empty())
    o.type = choice;
  else if (!o.shape.empty())
    o.type = grid;
  else if (o.target && o.type == number)
    o.type = o.target.type;
  if (o.target && o.default_value.empty() && !o.required && !o.no_default)
    o.default_value = default_in_field(o);
  return o;
}

}  // namespace

namespace fields_detail {

void place_files(std::string_view section, const void* owner, std::string_view directory,
                 void* settings) {
  for (const Option& o : options()) {
    if (o.section != section || o.target.owner != owner || !o.is_path) continue;
    std::string& file = *o.target.text(settings);
    if (!file.empty()) file = (std::filesystem::path(directory) / file).string();
  }
}

void take_reloadable(std::string_view section, const void* owner, const void* from, void* to) {
  for (const Option& o : options())
    if (o.section == section && o.target.owner == owner && o.reload && *o.reload != Reach::restart)
      o.target.copy(from, to);
}

}  // namespace fields_detail

std::span<const Option> options() {
  static const std::vector<Option> kAll = [] {
    std::vector<Option> all;
    for (const auto table :
         {structure_options, channel_options, estimator_options, lcm_options, can_options,
          watch_options, weather_options, history_options, event_report_options, action_options,
          fleet_options, scenario_options, effect_options, expectation_options, about_options})
      for (const OptionSection& some : table())
        for (const Option& row : some.rows) all.push_back(completed(row, some));
    return all;
  }();
  return kAll;
}

const Option* find_option(std::string_view section, std::string_view key) {
  const std::span<const Option> all = options();
  const auto at = std::find_if(all.begin(), all.end(), [&](const Option& o) {
    return o.section == section && o.key == key;
  });
  return at == all.end() ? nullptr : &*at;
}

std::vector<std::string> choices(const Option& option) {
  std::vector<std::string> out;
  std::size_t begin = 0;
  while (begin < option.choices.size()) {
    const std::size_t end = std::min(option.choices.find('|', begin), option.choices.size());
    out.emplace_back(option.choices.substr(begin, end - begin));
    begin = end + 1;
  }
  return out;
}

std::string constraint(const Option& option) {
  if (!option.choices.empty())
    return fmt::format("one of \"{}\"", fmt::join(choices(option), "\", \""));
  std::string rule;
  if (option.range.min > -kUnlimited)
    rule = fmt::format("{} {:.10g}", option.range.above_min ? ">" : ">=", option.range.min);
  if (option.range.max < kUnlimited)
    rule += fmt::format("{}<= {:.10g}", rule.empty() ? "" : " and ", option.range.max);
  if (!rule.empty() && !option.unit.empty()) rule += fmt::format(" {}", option.unit);
  return rule;
}

std::string expected(const Option& option) {
  const std::string unit = option.unit.empty() ? "" : fmt::format(" ({})", option.unit);
  switch (option.type) {
    case text:
      return "a text in quotes";
    case choice:
      return constraint(option);
    case integer:
      return "a whole number" + unit;
    case number:
      return "a number" + unit;
    case boolean:
      return "true or false";
    case texts:
      return "a list of texts";
    case grid:
      return fmt::format("a number{} or {}", unit, option.shape);
    case table:
      return "a table";
  }
  return "";
}

}  // namespace framewatch::daemon
