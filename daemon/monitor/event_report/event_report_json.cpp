// SPDX-License-Identifier: MIT

#include <nlohmann/json.hpp>

#include "daemon/base/json.h"
#include "daemon/base/utc_time.h"
#include "daemon/monitor/event_report/event_report.h"
#include "daemon/monitor/event_report/report_words.h"
#include "daemon/monitor/events/event_messages.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {
namespace {

Json mean_json(const estimator::WindowMean& m) {
  if (m.count == 0) return nullptr;
  return {{"value", json_value(m.value)}, {"std_error", json_value(m.std_error)}};
}

const char* before_word(estimator::BeforeFrom from) {
  constexpr const char* kWords[] = {"none", "baseline", "windows_before", "first_windows"};
  return kWords[static_cast<std::size_t>(from)];
}

/// Returns the times without samples. The peaks of the report are those of the remaining time.
Json unheard_json(const estimator::Shaking& shaking) {
  const std::vector<std::string> sentences = unheard_sentences(shaking);
  Json out = Json::array();
  for (std::size_t i = 0; i < sentences.size(); ++i) {
    const estimator::Unheard& u = shaking.unheard[i];
    const std::int64_t from_us = to_microseconds(u.from), to_us = to_microseconds(u.to);
    out.push_back(
        {{"from_us", u.from_known ? Json(from_us) : Json(nullptr)},
         {"to_us", to_us},
         {"seconds",
          u.from_known ? Json(1e-6 * static_cast<double>(to_us - from_us)) : Json(nullptr)},
         {"why", unheard_why(u.why)},
         {"drifts_from_us", to_us + static_cast<std::int64_t>(1e6 * shaking.drift_settles_s)},
         {"message", sentences[i]}});
  }
  return out;
}

Json stiffness_json(const EventReport& r, const Config& config) {
  const estimator::ParameterTable table = config.pipeline.parameters();
  Json out = Json::array();
  for (int p = 0; p < table.elements(); ++p) {
    const estimator::ShakenStiffness& k = r.shaking.stiffness[static_cast<std::size_t>(p)];
    out.push_back({{"parameter", table[p].name},
                   {"unit", table[p].unit},
                   {"before", mean_json(k.before)},
                   {"before_from", before_word(k.before_from)},
                   {"during", mean_json(k.during)},
                   {"after", mean_json(k.after)},
                   {"after_from", k.free ? "free_vibration" : "last_windows"},
                   {"change_ratio", json_value(k.known() ? k.ratio() : estimator::kNaN)},
                   {"change_std_error", json_value(k.known() ? k.std_error() : estimator::kNaN)}});
  }
  return out;
}

Json sensors_json(const EventReport& r, const Config& config) {
  Json out = Json::array();
  for (std::size_t a = 0; a < r.axes.size(); ++a) {
    const estimator::AxisCounters& c = r.axes[a];
    out.push_back({{"channel", config.pipeline.axes[a].name},
                   {"story", config.pipeline.axes[a].story},
                   {"peak_accel_mps2", json_value(r.shaking.peak.accel_mps2[a])},
                   {"received", c.received},
                   {"missing", c.missing},
                   {"late", c.late},
                   {"repaired", c.repaired},
                   {"stuck", c.stuck},
                   {"clipped", c.clipped},
                   {"rejected", c.rejected}});
  }
  return out;
}

}  // namespace

std::string event_report_json(const EventReport& r, const Config& config) {
  const EventVerdict verdict = judge(r, config);
  const EventReportSettings& s = *config.event_report;
  Json out{{"schema", "framewatch.event_report/1"},
           {"building", config.pipeline.structure.name},
           {"unheard", unheard_json(r.shaking)},
           {"verdict", color_word(verdict.color)},
           {"reasons", verdict.reasons},
           {"start_us", to_microseconds(r.shaking.start)},
           {"end_us", to_microseconds(r.shaking.end)},
           {"start", utc_text(to_microseconds(r.shaking.start))},
           {"end", utc_text(to_microseconds(r.shaking.end))},
           {"thresholds",
            {{"yellow_drift_ratio", s.yellow_drift_ratio},
             {"red_drift_ratio", s.red_drift_ratio},
             {"yellow_loss_ratio", s.yellow_loss_ratio},
             {"red_loss_ratio", s.red_loss_ratio}}}};
  add_drifts(drift_report(r, config), config, out);
  out["base_shear_n"] = {{"x", json_value(r.shaking.peak.base_shear_n[0])},
                         {"y", json_value(r.shaking.peak.base_shear_n[1])}};
  out["stiffness"] = stiffness_json(r, config);
  out["gap_nrmse"] = json_value(r.shaking.gap_nrmse);
  out["findings"] = Json::array();
  for (const event_t& e : r.findings)
    out["findings"].push_back({{"time_us", e.time_us},
                               {"kind", e.kind},
                               {"state", word(kEventStates, e.state)},
                               {"severity", word(kSeverities, e.severity)},
                               {"place", e.place},
                               {"message", e.message}});
  out["sensors"] = sensors_json(r, config);
  out["config_sha256"] = config.sha256;
  out["version"] = FRAMEWATCH_VERSION;
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace framewatch::daemon
