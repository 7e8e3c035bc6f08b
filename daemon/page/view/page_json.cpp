// SPDX-License-Identifier: MIT
#include "daemon/page/view/page_json.h"

#include <algorithm>
#include <utility>

#include <nlohmann/json.hpp>

#include "daemon/base/json.h"
#include "daemon/monitor/estimates/estimate_table.h"
#include "daemon/monitor/events/change_words.h"
#include "daemon/tools/report/record_modes.h"
#include "estimator/numeric/nan.h"
#include "estimator/structure/group_design.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::daemon {
namespace {

Json line_json(const AnswerLine& line) {
  return {{"text", line.text},
          {"since_us", line.since_us},
          {"until_us", line.until_us},
          {"report", line.report}};
}

}  // namespace

std::string estimate_json(const window_estimate_t& e, double min_snr) {
  std::vector<int> reason(e.reason.begin(), e.reason.end());
  for (std::size_t p = 0; p < std::min(reason.size(), e.snr.size()); ++p)
    reason[p] = told_reason(reason[p], static_cast<double>(e.snr[p]), min_snr);
  return fmt::format(R"({{"start_us":{},"end_us":{},"sequence":{},"status":{},"rows":{},)"
                     R"("residual":{},"value":{},"error":{},"reason":{},"snr":{}}})",
                     e.window_start_us, e.window_end_us, e.sequence, e.status, e.rows,
                     json_value_text(e.residual_ratio), json_list(e.value),
                     json_list(e.std_error, "{:.4g}"), json_list(reason),
                     json_list(e.snr, "{:.3g}"));
}

std::string model_fit_json(const model_fit_t& f) {
  return fmt::format(R"({{"error":{},"word":{}}})", json_list(f.error, "{:.3g}"),
                     json_list(f.word));
}

std::string boxes_json(const window_estimate_t& e) {
  return fmt::format(
      R"({{"windows":{},"q1":{},"median":{},"q3":{},"low":{},"high":{},"outliers":{},"count":{}}})",
      e.boxplot_windows, json_list(e.q1, "{:.6g}"), json_list(e.median, "{:.6g}"),
      json_list(e.q3, "{:.6g}"), json_list(e.whisker_low, "{:.6g}"),
      json_list(e.whisker_high, "{:.6g}"), json_list(e.outliers), json_list(e.boxplot_count));
}

std::string modes_json(const PageModes& m) {
  std::string modes;
  for (const estimator::NaturalMode& mode : m.modes) {
    const bool damping = m.why_no_damping.empty();
    const Eigen::VectorXd real = mode.shape.real(), imaginary = mode.shape.imag();
    modes += fmt::format(
        R"({}{{"hz":{},"hz_error":{},"ratio":{},"ratio_error":{},"motion":"{}","re":{},"im":{}}})",
        modes.empty() ? "" : ",", json_value_text(mode.frequency_hz),
        json_value_text(mode.frequency_error_hz),
        json_value_text(damping ? mode.damping_ratio : estimator::kNaN),
        json_value_text(damping ? mode.damping_error : estimator::kNaN), motion_words(mode),
        json_list(std::vector<double>(real.begin(), real.end()), "{:.3f}"),
        json_list(std::vector<double>(imaginary.begin(), imaginary.end()), "{:.3f}"));
  }
  return fmt::format(R"({{"modes":[{}],"why":{},"why_no_damping":{},"oldest_us":{}}})", modes,
                     json_line(m.why), json_line(m.why_no_damping), m.oldest_us);
}

std::string baseline_json(const std::vector<double>& baseline) {
  return "{\"value\":" + json_list(baseline) + "}";
}

std::string status_json(const status_t& s, const std::string& config_sha256) {
  Json channels = Json::array();
  for (std::size_t i = 0; i < s.name.size(); ++i) {
    Json one{{"name", s.name[i]},   {"received", s.received[i]}, {"lost", s.lost[i]},
             {"late", s.late[i]},   {"repaired", s.repaired[i]}, {"rejected", s.rejected[i]},
             {"stuck", s.stuck[i]}, {"clipped", s.clipped[i]}};
    one["noise"] = json_value(s.noise_mps2_per_rthz[i]);
    channels.push_back(std::move(one));
  }
  return json_line({{"time_us", s.time_us},
                    {"windows", s.windows},
                    {"sets", s.sample_sets},
                    {"gaps", s.gaps},
                    {"refused", s.rejected_messages},
                    {"queue_high", s.queue_high_water},
                    {"queue_dropped", s.queue_dropped},
                    {"latency_s", s.latency_s},
                    {"same_config", s.config_sha256 == config_sha256},
                    {"channels", channels}});
}

std::string gap_json(const gap_t& g) {
  return fmt::format(
      R"({{"start_us":{},"end_us":{},"overall":{},"noise_floor":{},"name":{},"nrmse":{},"floor":{}}})",
      g.window_start_us, g.window_end_us, json_value_text(g.overall_nrmse),
      json_value_text(g.noise_floor), json_line(g.name), json_list(g.nrmse, "{:.4g}"),
      json_list(g.floor, "{:.4g}"));
}

std::string can_json(const can_status_t& s) {
  Json buses = Json::array();
  for (std::size_t i = 0; i < s.interface.size(); ++i)
    buses.push_back({{"interface", s.interface[i]},
                     {"state", s.state[i]},
                     {"frames_hz", json_value(s.frames_hz[i])},
                     {"load", json_value(s.load[i])},
                     {"expected_load", json_value(s.expected_load[i])},
                     {"error_frames", s.error_frames[i]},
                     {"bus_off", s.bus_off[i]},
                     {"bus_errors", s.bus_errors[i]},
                     {"overflow", s.overflow[i]}});
  return json_line({{"time_us", s.time_us}, {"dropped", s.dropped}, {"buses", buses}});
}

std::string session_status_json(const session_status_t& s) {
  Json channels = Json::array();
  for (std::size_t i = 0; i < s.name.size(); ++i)
    channels.push_back({{"name", s.name[i]},
                        {"noise", json_value(s.noise_mps2_per_rthz[i])},
                        {"rms", json_value(s.rms_mps2[i])},
                        {"offset", json_value(s.offset_mps2[i])},
                        {"peak", json_value(s.peak_mps2[i])},
                        {"range", json_value(s.range_mps2[i])},
                        {"saturated", s.saturated[i]},
                        {"polarity", s.polarity[i]},
                        {"problem", s.problem[i]}});
  // Ids exceed the integers that JavaScript represents exactly.
  return json_line({{"time_us", s.time_us},
                    {"state", s.state},
                    {"test", s.test},
                    {"session", s.session},
                    {"report", s.report},
                    {"message", s.message},
                    {"answered", std::to_string(s.answered)},
                    {"refused", s.refused},
                    {"elapsed_s", json_value(s.elapsed_s)},
                    {"length_s", json_value(s.length_s)},
                    {"trigger_mps2", json_value(s.trigger_mps2)},
                    {"messages", s.messages},
                    {"estimates", s.estimates},
                    {"lost", s.lost},
                    {"dropped", s.dropped},
                    {"bytes", s.bytes},
                    {"disk_free_bytes", s.disk_free_bytes},
                    {"channels", channels}});
}

std::string refused_json(std::int64_t id, const std::string& problem) {
  return json_line({{"answered", std::to_string(id)}, {"refused", problem}});
}

std::string alarm_json(const event_t& e, bool acknowledged, const Acknowledgement& by) {
  return json_line({{"id", e.id},
                    {"time_us", e.time_us},
                    {"since_us", e.since_us},
                    {"state", e.state},
                    {"severity", e.severity},
                    {"kind", e.kind},
                    {"place", e.place},
                    {"value", json_value(e.value)},
                    {"error", json_value(e.std_error)},
                    {"unit", e.unit},
                    {"message", e.message},
                    {"acknowledged", acknowledged},
                    {"who", by.who},
                    {"comment", by.comment}});
}

std::string building_json(const Config& config, double rate_hz) {
  const estimator::Structure& s = config.pipeline.structure;
  const estimator::ParameterTable table = config.pipeline.parameters();
  Json parameters = Json::array();
  const Eigen::VectorXd design =
      table.grouped() && config.pipeline.design.size() > 0
          ? group_parameters(s, table, {config.pipeline.design, config.pipeline.bending_nmprad})
          : config.pipeline.design;
  for (int p = 0; p < table.size(); ++p) {
    parameters.push_back({{"name", table[p].name},
                          {"unit", table[p].unit},
                          {"kind", static_cast<int>(table[p].kind)},
                          {"story", table[p].story},
                          {"frames", table[p].frames},
                          {"design", design.size() > p ? Json(design[p]) : Json(nullptr)}});
    if (table[p].last_story > table[p].story) parameters.back()["last_story"] = table[p].last_story;
    if (table[p].panel >= 0)
      parameters.back()["panel"] = table[p].panel;
    else
      parameters.back()["direction"] = letter(table[p].direction);
  }
  Json axes = Json::array();
  for (const estimator::SensorAxis& a : config.pipeline.axes) {
    axes.push_back(
        {{"name", a.name}, {"story", a.story}, {"direction", letter(a)}, {"frame", a.frame}});
    if (a.plan) axes.back().update({{"x_m", a.plan->x_m}, {"y_m", a.plan->y_m}});
  }
  const estimator::EstimatorOptions& o = config.pipeline.options;
  return json_line({{"name", s.name},
                    {"stories", s.stories},
                    {"frames_x", s.frames_x},
                    {"frames_y", s.frames_y},
                    {"labels", frame_labels(s)},
                    {"span_x_m", s.span_x},
                    {"span_y_m", s.span_y},
                    {"story_height_m", s.story_height},
                    {"rigid", s.floor == estimator::FloorModel::rigid},
                    {"grouped", table.grouped()},
                    {"parameters", parameters},
                    {"axes", axes},
                    {"rate_hz", rate_hz},
                    {"history", config.history.has_value()},
                    {"window_s", o.window_s},
                    {"high_pass_hz", o.high_pass_hz},
                    {"watch", config.watch.has_value()},
                    {"version", FRAMEWATCH_VERSION},
                    {"config_sha256", config.sha256}});
}

std::string answers_json(const Known& known, const Config& config) {
  constexpr const char* kStates[] = {"good", "look", "bad", "wait"};
  constexpr const char* kKinds[] = {"change", "shake", "belief", "service"};
  Json questions = Json::array(), findings = Json::array(), drift = Json::array();
  for (const Answer& a : answers(known, config)) {
    Json more = Json::array();
    for (const AnswerLine& line : a.more) more.push_back(line_json(line));
    questions.push_back({{"question", a.question},
                         {"state", kStates[static_cast<int>(a.state)]},
                         {"line", line_json(a.line)},
                         {"more", more}});
  }
  for (const Finding& f : known.findings)
    findings.push_back({{"id", f.id},
                        {"kind", kKinds[static_cast<int>(f.kind)]},
                        {"severity", f.severity},
                        {"place", f.place},
                        {"since_us", f.since_us},
                        {"ratio", json_value(f.change_ratio)},
                        {"error", json_value(f.std_error)},
                        {"of_channel", f.of_channel},
                        {"text", f.text},
                        {"advice", f.advice},
                        {"acknowledged", f.acknowledged},
                        {"who", f.who}});
  const estimator::Structure& s = config.pipeline.structure;
  for (int story = 1; known.newest != nullptr && story <= s.stories; ++story) {
    const estimator::PeakDrift peak = peak_drift(known.newest->peak, s, story);
    const auto i = static_cast<std::size_t>(story - 1);
    drift.push_back({{"ratio", json_value(peak.ratio)},
                     {"frame", peak.frame},
                     {"std_error", json_value(i < known.drifts.size() ? known.drifts[i].std_error
                                                                      : estimator::kNaN)}});
  }
  return json_line({{"answers", questions}, {"findings", findings}, {"drift", drift}});
}

}  // namespace framewatch::daemon
