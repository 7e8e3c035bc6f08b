#include "daemon/config_changes.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include <fmt/core.h>

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
    // An empty table may say something by being there.
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

/// "channel[3].scale" is "channel.scale".
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

Reach reach_of(const std::string& key) {
  constexpr std::array kSettings = {"watch",
                                    "gap",
                                    "actions",
                                    "lcm.boxplot_every",
                                    "estimator.min_snr",
                                    "estimator.max_error_k_ratio",
                                    "estimator.max_error_g_ratio",
                                    "estimator.max_error_c_ratio"};
  const std::string name = without_numbers(key);
  if (name == "watch.temperature_channel") return Reach::restart;  // subscriptions stay
  for (const std::string setting : kSettings)
    if (name == setting || name.starts_with(setting + ".")) return Reach::settings;
  if (name == "channel.noise_mps2_per_rthz") return Reach::window;
  return Reach::restart;
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

void take_settings(Config& running, const Config& fresh) {
  running.sha256 = fresh.sha256;
  running.pipeline.options = fresh.pipeline.options;
  for (std::size_t a = 0; a < running.pipeline.axes.size(); ++a)
    running.pipeline.axes[a].noise_density = fresh.pipeline.axes[a].noise_density;
  running.lcm.boxplot_every = fresh.lcm.boxplot_every;
  running.watch = fresh.watch;
  running.gap = fresh.gap;
  running.actions = fresh.actions;
}

}  // namespace framewatch::daemon
