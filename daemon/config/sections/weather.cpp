// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "daemon/config/keys/section.h"
#include "daemon/config/sections/config_problems.h"
#include "daemon/config/sections/sections.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kMostCovariates = 20, kLongestName = 63, kMostTopic_bytes = 1024;
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

bool has_control_character(const std::string& text) {
  return std::ranges::any_of(text, [](unsigned char c) { return c < ' ' || c == 127; });
}

/// Returns the rule that a topic breaks, or an empty text.
std::string problem_of_topic(const std::string& topic) {
  if (topic.empty() || topic.size() > kMostTopic_bytes)
    return fmt::format("a topic has 1 to {} bytes", kMostTopic_bytes);
  if (topic.find_first_of("+#") != std::string::npos)
    return "must be one topic: no + and no #, which stand for many";
  if (has_control_character(topic)) return "must not contain control characters";
  return {};
}

/// Returns true if the text is a JSON pointer (RFC 6901).
bool is_json_pointer(const std::string& text) {
  if (!text.starts_with('/')) return false;
  for (std::size_t at = text.find('~'); at != std::string::npos; at = text.find('~', at + 1))
    if (at + 1 == text.size() || (text[at + 1] != '0' && text[at + 1] != '1')) return false;
  return true;
}

void check_topic(ConfigSection& section) {
  if (section.given("mqtt"))
    if (const std::string rule = problem_of_topic(section.text("mqtt")); !rule.empty())
      section.problem("mqtt", rule);
  for (const char* key : {"field", "time_field"}) {
    if (!section.given(key)) continue;
    if (section.value("mqtt") == nullptr)
      section.problem(key, "needs mqtt: it is for payloads of a topic");
    else if (!is_json_pointer(section.text(key)))
      section.problem(key, fmt::format("\"{}\": must be a JSON pointer, such as \"/temperature\"",
                                       section.text(key)));
  }
  if (section.given("time_field") && section.value("field") == nullptr)
    section.problem("time_field", "needs field: a payload with a time is JSON");
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
  for (const auto& [one, other] :
       {std::pair{"thermometer", "can"}, {"mqtt", "thermometer"}, {"mqtt", "can"}})
    if (section.given(one) && section.given(other))
      section.problem(one,
                      fmt::format("must not be given with {}: a covariate has one source", other));
  check_topic(section);
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

std::optional<drivers::MqttSettings> read_mqtt(const TomlValue& document, Config& config,
                                               std::vector<TextProblem>& problems) {
  if (document.find("mqtt") == nullptr) {
    for (const WeatherSettings& w : config.weather)
      if (!w.mqtt.empty())
        problems.push_back(
            {{},
             fmt::format("weather '{}': source.mqtt needs a section [mqtt] with the url of the "
                         "broker",
                         w.name)});
    return std::nullopt;
  }
  ConfigSection section("mqtt", document, problems);
  auto out = section.read<drivers::MqttSettings>();
  const auto address = drivers::mqtt_address(out.url);
  if (section.given("url") && !address)
    section.problem("url", fmt::format("\"{}\": must be such as mqtts://broker.example.org or "
                                       "mqtt://localhost:1883, without user and password",
                                       out.url));
  for (const char* key : {"ca_file", "certificate_file", "key_file"})
    if (section.given(key) && address && !address->tls)
      section.problem(key, "needs TLS: a url that begins with mqtts://");
  for (const auto& [one, other] :
       {std::pair{"certificate_file", "key_file"}, std::pair{"key_file", "certificate_file"},
        std::pair{"password_file", "user"}})
    if (section.given(one) && section.value(other) == nullptr)
      section.problem(one, fmt::format("needs {}", other));
  for (const char* key : {"user", "client_id"})
    if (has_control_character(section.text(key)))
      section.problem(key, "must not contain control characters");
  if (address && !address->tls && !drivers::is_this_machine(*address) && !out.password_file.empty())
    config.doubts.push_back(
        {config.path, fmt::format("mqtt.url: the password crosses the network to {} unencrypted. "
                                  "Use mqtts:// if the broker has TLS",
                                  address->host)});
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
