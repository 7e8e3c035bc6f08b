// SPDX-License-Identifier: MIT
#include "daemon/config/changes.h"

#include <algorithm>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/file_digest.h"
#include "daemon/config/keys/section_table.h"

namespace framewatch::daemon {
namespace {

struct Leaf {
  std::string text;
  TextPlace place;
};
using Leaves = std::map<std::string, Leaf>;

std::string as_toml(const TomlValue& value) {
  switch (value.kind) {
    case TomlKind::text:
      return fmt::format("\"{}\"", value.text);
    case TomlKind::boolean:
      return value.boolean ? "true" : "false";
    case TomlKind::integer:
    case TomlKind::number:
      return fmt::format("{}", value.number);
    default:
      break;
  }
  std::string items;
  for (const TomlValue& item : value.items) items += (items.empty() ? "" : ", ") + as_toml(item);
  for (const TomlEntry& entry : value.entries)
    items += (items.empty() ? "" : ", ") + entry.key + " = " + as_toml(entry.value);
  return value.kind == TomlKind::array ? "[" + items + "]" : "{" + items + "}";
}

bool is_list_of_tables(const TomlValue& value) {
  return value.kind == TomlKind::array && !value.items.empty() &&
         value.items.front().kind == TomlKind::table;
}

void collect(const std::string& key, const TomlValue& value, Leaves& out) {
  if (value.kind == TomlKind::table) {
    // An empty table can enable a feature.
    if (!key.empty() && value.entries.empty()) out[key] = {"{}", value.place};
    for (const TomlEntry& entry : value.entries)
      collect(key.empty() ? entry.key : key + "." + entry.key, entry.value, out);
  } else if (is_list_of_tables(value)) {
    for (std::size_t i = 0; i < value.items.size(); ++i)
      collect(fmt::format("{}[{}]", key, i + 1), value.items[i], out);
  } else {
    out[key] = {as_toml(value), value.place};
  }
}

/// Returns "channel.scale" for "channel[3].scale".
std::string without_numbers(const std::string& key) {
  std::string out;
  bool inside = false;
  for (const char c : key) {
    if (c == '[') inside = true;
    if (!inside) out += c;
    if (c == ']') inside = false;
  }
  return out;
}

/// Returns the reach of a key, or of a section without keys.
Reach reach_of(const std::string& key) {
  const std::string name = without_numbers(key);
  const std::size_t dot = name.rfind('.');
  const Option* option =
      dot == std::string::npos ? nullptr : find_option(name.substr(0, dot), name.substr(dot + 1));
  if (option != nullptr) return option->reload.value_or(Reach::restart);
  const SectionDescription* section = find_section(name);
  return section == nullptr ? Reach::restart : section->reload.value_or(Reach::restart);
}

/// Copies an optional section. Adds or removes it as a whole if that is allowed.
template <class Settings>
void take_section(std::string_view section, const std::optional<Settings>& from,
                  std::optional<Settings>& to) {
  if (find_section(section)->reload != Reach::restart)
    to = from;
  else if (from && to)
    take_reloadable(section, *from, *to);
}

}  // namespace

std::string ConfigChange::described() const {
  return fmt::format("{}: {} -> {}", key, before.empty() ? "not given" : before,
                     after.empty() ? "not given" : after);
}

std::vector<ConfigChange> changes_between(const TomlValue& before, const TomlValue& after) {
  Leaves old_leaves, new_leaves;
  collect("", before, old_leaves);
  collect("", after, new_leaves);
  Leaves every = old_leaves;
  every.insert(new_leaves.begin(), new_leaves.end());
  const auto text_in = [](const Leaves& leaves, const std::string& key) {
    const auto found = leaves.find(key);
    return found == leaves.end() ? std::string() : found->second.text;
  };
  std::vector<ConfigChange> out;
  for (const auto& [key, leaf] : every) {
    ConfigChange change{key, text_in(old_leaves, key), text_in(new_leaves, key), {}, reach_of(key)};
    if (change.before == change.after) continue;
    if (const auto found = new_leaves.find(key); found != new_leaves.end())
      change.place = found->second.place;
    out.push_back(std::move(change));
  }
  return out;
}

std::map<std::string, std::string> section_digests(const TomlValue& document) {
  Leaves leaves;
  collect("", document, leaves);
  std::map<std::string, std::string> out;
  for (const auto& [key, leaf] : leaves)
    out[key.substr(0, key.find_first_of(".["))] += key + " = " + leaf.text + "\n";
  for (auto& [section, text] : out) text = sha256(text);
  return out;
}

Config reloaded(const Config& running, const Config& fresh) {
  Config out = running;
  out.sha256 = fresh.sha256;
  out.section_sha256 = fresh.section_sha256;
  take_reloadable("estimator", fresh.pipeline.options, out.pipeline.options);
  out.pipeline.options.long_window_s = fresh.pipeline.options.long_window_s;  // [watch] has it
  for (std::size_t a = 0; a < out.pipeline.axes.size(); ++a)
    take_reloadable("channel", fresh.pipeline.axes[a], out.pipeline.axes[a]);
  take_reloadable("lcm", fresh.lcm, out.lcm);
  take_section("watch", fresh.watch, out.watch);
  take_section("gap", fresh.gap, out.gap);
  take_section("history", fresh.history, out.history);
  take_section("event_report", fresh.event_report, out.event_report);
  take_section("fragility", fresh.fragility, out.fragility);
  take_section("actions", fresh.actions, out.actions);
  take_section("email", fresh.email, out.email);
  take_section("report", fresh.report, out.report);
  take_section("fleet", fresh.fleet, out.fleet);
  return out;
}

}  // namespace framewatch::daemon
