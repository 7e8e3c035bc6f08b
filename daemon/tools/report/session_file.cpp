// SPDX-License-Identifier: MIT
#include "daemon/tools/report/session_file.h"

#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/base/file_digest.h"
#include "daemon/base/json.h"
#include "daemon/base/utc_time.h"
#include "drivers/files/number_text.h"

namespace framewatch::daemon {
namespace {

constexpr const char* kSchema = "framewatch.session/1";
constexpr double kLongest_s = 7 * 86400, kLongestBefore_s = 60, kHighest_mps2 = 1000;
constexpr std::size_t kLongestName = 200, kLongestNotes = 4000, kLongestSlug = 40;
constexpr std::array<std::pair<const char*, StageKind>, 3> kStages{
    {{"quiet", StageKind::quiet}, {"forced", StageKind::forced}, {"free", StageKind::free}}};

Json channels_json(const std::vector<ChannelResult>& results) {
  Json out = Json::array();
  for (const ChannelResult& r : results)
    out.push_back({{"name", r.name},
                   {"noise_mps2_per_rthz", json_value(r.noise_density)},
                   {"rms_mps2", json_value(r.rms)},
                   {"offset_mps2", json_value(r.offset)},
                   {"peak_mps2", json_value(r.peak)},
                   {"range_mps2", json_value(r.range)},
                   {"samples", r.samples},
                   {"missing", r.missing},
                   {"saturated", r.saturated},
                   {"stuck", r.stuck},
                   {"polarity", r.polarity},
                   {"problem", r.problem}});
  return out;
}

double double_of(const Json& json, const char* key) {
  const Json& value = json.at(key);
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

std::vector<ChannelResult> read_channels(const Json& json) {
  std::vector<ChannelResult> out;
  for (const Json& c : json) {
    ChannelResult r;
    r.name = c.at("name").get<std::string>();
    r.noise_density = double_of(c, "noise_mps2_per_rthz");
    r.rms = double_of(c, "rms_mps2");
    r.offset = double_of(c, "offset_mps2");
    r.peak = double_of(c, "peak_mps2");
    r.range = double_of(c, "range_mps2");
    c.at("samples").get_to(r.samples);
    c.at("missing").get_to(r.missing);
    c.at("saturated").get_to(r.saturated);
    c.at("stuck").get_to(r.stuck);
    c.at("polarity").get_to(r.polarity);
    c.at("problem").get_to(r.problem);
    out.push_back(std::move(r));
  }
  return out;
}

Json stages_json(const std::vector<Stage>& stages) {
  Json out = Json::array();
  for (const Stage& stage : stages)
    out.push_back({{"stage", kStages[static_cast<std::size_t>(stage.kind)].first},
                   {"from_us", stage.from_us},
                   {"to_us", stage.to_us}});
  return out;
}

SessionFile session_of(const Json& j) {
  SessionFile s;
  j.at("state").get_to(s.state);
  j.at("test").get_to(s.request.test);
  j.at("operator").get_to(s.request.operator_name);
  j.at("notes").get_to(s.request.notes);
  s.asked_by = j.value("asked_by", "");
  j.at("length_s").get_to(s.request.length_s);
  j.at("trigger_mps2").get_to(s.request.trigger_mps2);
  j.at("pre_trigger_s").get_to(s.request.pre_trigger_s);
  j.at("configuration").at("path").get_to(s.config_path);
  j.at("configuration").at("sha256").get_to(s.config_sha256);
  j.at("version").get_to(s.version);
  j.at("began_us").get_to(s.began_us);
  j.at("trigger_us").get_to(s.trigger_us);
  j.at("end_us").get_to(s.end_us);
  j.at("triggered_by").get_to(s.triggered_by);
  j.at("ended_by").get_to(s.ended_by);
  j.at("messages").get_to(s.messages);
  j.at("estimates").get_to(s.estimates);
  j.at("lost").get_to(s.lost);
  j.at("dropped").get_to(s.dropped);
  s.check = read_channels(j.at("check"));
  s.run = read_channels(j.at("run"));
  for (const Json& stage : j.at("stages"))
    for (const auto& [name, kind] : kStages)
      if (stage.at("stage") == name)
        s.stages.push_back(
            {kind, stage.at("from_us").get<std::int64_t>(), stage.at("to_us").get<std::int64_t>()});
  j.at("files").get_to(s.files);
  j.at("report").get_to(s.report);
  j.at("problems").get_to(s.problems);
  j.at("finishing").get_to(s.finishing);
  return s;
}

/// Returns the schema of `json` if a later version wrote it; otherwise nullopt.
std::optional<std::string> newer_schema(const Json& json) {
  const std::string prefix = "framewatch.session/";
  const auto schema = json.at("schema").get<std::string>();
  if (!schema.starts_with(prefix)) return std::nullopt;
  const auto number = drivers::parse_integer(std::string_view(schema).substr(prefix.size()));
  return number && *number > 1 ? std::optional(schema) : std::nullopt;
}

}  // namespace

std::string session_json(const SessionFile& s) {
  const Json json{{"schema", kSchema},
                  {"state", s.state},
                  {"test", s.request.test},
                  {"operator", s.request.operator_name},
                  {"notes", s.request.notes},
                  {"asked_by", s.asked_by},
                  {"length_s", s.request.length_s},
                  {"trigger_mps2", s.request.trigger_mps2},
                  {"pre_trigger_s", s.request.pre_trigger_s},
                  {"configuration", {{"path", s.config_path}, {"sha256", s.config_sha256}}},
                  {"version", s.version},
                  {"began_us", s.began_us},
                  {"began", sensor_time_text(s.began_us)},
                  {"trigger_us", s.trigger_us},
                  {"end_us", s.end_us},
                  {"triggered_by", s.triggered_by},
                  {"ended_by", s.ended_by},
                  {"messages", s.messages},
                  {"estimates", s.estimates},
                  {"lost", s.lost},
                  {"dropped", s.dropped},
                  {"stages", stages_json(s.stages)},
                  {"files", s.files},
                  {"report", s.report},
                  {"problems", s.problems},
                  {"finishing", s.finishing},
                  {"check", channels_json(s.check)},
                  {"run", channels_json(s.run)}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::optional<SessionFile> parse_session(const std::string& text, std::string& error) {
  try {
    const Json json = Json::parse(text);
    if (json.at("schema") == kSchema) return session_of(json);
    error = fmt::format("is not of schema {}", kSchema);
    if (const auto newer = newer_schema(json))
      error = fmt::format("a newer framewatch wrote it ({}, this one knows {})", *newer, kSchema);
  } catch (const Json::exception& e) {
    error = e.what();
  }
  return std::nullopt;
}

std::optional<SessionFile> read_session_file(const std::string& path, std::string& error) {
  const auto text = read_text_file(path, error);
  return text ? parse_session(*text, error) : std::nullopt;
}

std::string session_folder_name(std::int64_t began_us, const std::string& test) {
  std::string name = sensor_time_text(began_us).substr(0, 19);
  for (char& c : name) c = c == ' ' ? 'T' : c == ':' ? '-' : c;
  std::string slug;
  for (const char c : test.substr(0, kLongestSlug)) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (plain)
      slug += c;
    else if (!slug.empty() && slug.back() != '-')
      slug += '-';
  }
  while (!slug.empty() && slug.back() == '-') slug.pop_back();
  return slug.empty() ? name : name + "_" + slug;
}

std::vector<std::string> problems(const SessionRequest& r) {
  std::vector<std::string> out;
  const auto within = [&](const char* what, double value, double most, const char* unit) {
    if (!(value >= 0 && value <= most))
      out.push_back(fmt::format("{} {:g} {} is not between 0 and {:g}", what, value, unit, most));
  };
  within("length", r.length_s, kLongest_s, "s");
  within("trigger level", r.trigger_mps2, kHighest_mps2, "m/s^2");
  within("pre-trigger", r.pre_trigger_s, kLongestBefore_s, "s");
  if (r.test.size() > kLongestName || r.operator_name.size() > kLongestName)
    out.push_back(fmt::format("a name has more than {} bytes", kLongestName));
  if (r.notes.size() > kLongestNotes)
    out.push_back(fmt::format("the notes have more than {} bytes", kLongestNotes));
  return out;
}

}  // namespace framewatch::daemon
