// SPDX-License-Identifier: MIT
#include <algorithm>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "daemon/config/keys/section.h"
#include "daemon/config/sections/config_problems.h"
#include "daemon/config/sections/sections.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kMostCovariates = 20, kLongestName = 63;
constexpr const char* kImpliedName = "temperature_degc";

/// Returns the rule that the name of a covariate breaks, or an empty text.
std::string problem_of_covariate(const std::string& name) {
  if (std::string rule = problem_of_name(name); !rule.empty()) return rule;
  if (name.size() > kLongestName) return fmt::format("has more than {} characters", kLongestName);
  if (name == "time") return "is the name of the time in tables";
  if (covariate_unit(name) == nullptr)
    return fmt::format("\"{}\": must end with its unit: {}", name, covariate_endings());
  return {};
}

void read_weather_source(ConfigSection& weather, const std::string& label, WeatherSettings& out,
                         const Config& config, std::vector<TextProblem>& problems) {
  if (!weather.given("source")) return;
  ConfigSection section("weather.source", label + ".source", weather.value("source"), {}, problems);
  section.read_into(out);
  for (const char* key : {"lcm", "thermometer"})
    if (section.given(key) &&
        (section.text(key).empty() || section.text(key).size() > kLongestName))
      section.problem(key, "an LCM channel's name has 1 to 63 characters");
  for (const AxisSource& axis : config.sources)
    for (const char* key : {"lcm", "thermometer"})
      if (section.given(key) && section.text(key) == axis.lcm_channel)
        section.problem(key, fmt::format("{} is the LCM channel of samples", axis.lcm_channel));
  if (section.given("can") != section.given("dbc_signal"))
    section.problem(section.given("can") ? "can" : "dbc_signal",
                    "can and dbc_signal belong together");
  if (section.given("thermometer") && section.given("can"))
    section.problem("thermometer", "must not be given with can: a covariate has one source");
  const CovariateUnit* unit = covariate_unit(out.name);
  if (section.given("thermometer") && unit != nullptr && !unit->freezes)
    section.problem("thermometer",
                    fmt::format("needs a temperature, and {} is another quantity", out.name));
}

}  // namespace

std::vector<WeatherSettings> read_weather_tables(const TomlValue& document, const Config& config,
                                                 std::vector<TextProblem>& problems) {
  std::vector<WeatherSettings> out;
  for (const TomlValue* table : tables_of(document, "weather", problems)) {
    const TomlEntry* entry = table->kind == TomlKind::table ? table->find("name") : nullptr;
    const std::string label =
        entry != nullptr ? fmt::format("weather '{}'", entry->value.text) : "weather";
    ConfigSection section("weather", label, table, {}, problems);
    auto settings = section.read<WeatherSettings>();
    if (section.given("name")) {
      if (const std::string rule = problem_of_covariate(settings.name); !rule.empty())
        section.problem("name", rule);
      else if (std::ranges::find(out, settings.name, &WeatherSettings::name) != out.end())
        section.problem("name", fmt::format("{} is the name of another one", settings.name));
    }
    if (section.given("scale") && settings.scale == 0) section.problem("scale", "must not be 0");
    read_weather_source(section, label, settings, config, problems);
    const CovariateUnit* unit = covariate_unit(settings.name);
    if (unit != nullptr && !section.given("stuck_after_s"))
      settings.stuck_after_s = unit->stuck_after_s;
    if (out.size() == kMostCovariates)
      section.problem("", fmt::format("at most {} tables", kMostCovariates));
    out.push_back(std::move(settings));
  }
  return out;
}

void add_thermometer(Config& config) {
  if (!config.watch || config.watch->temperature_channel.empty()) return;
  const auto heard = [&](const WeatherSettings& w) {
    return w.name == kImpliedName || w.thermometer == config.watch->temperature_channel;
  };
  if (config.weather.size() == kMostCovariates || std::ranges::any_of(config.weather, heard))
    return;
  WeatherSettings implied;
  implied.name = kImpliedName;
  implied.thermometer = config.watch->temperature_channel;
  implied.stuck_after_s = covariate_unit(kImpliedName)->stuck_after_s;
  config.weather.push_back(std::move(implied));
}

}  // namespace framewatch::daemon
