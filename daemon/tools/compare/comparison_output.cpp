// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/base/json.h"
#include "daemon/base/words.h"
#include "daemon/tools/compare/comparison.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {
namespace {

/// Returns a difference without limits.
Json size_json(const Difference& d) {
  return {{"ratio", json_value(d.ratio)},
          {"std_error_ratio", json_value(d.std_error)},
          {"std_errors", json_value(d.errors())}};
}

Json judged_json(const Difference& d) {
  Json out = size_json(d);
  out["judged"] = d.judged;
  out["different"] = d.different;
  return out;
}

Json differences_of(const Comparison& c, std::size_t p) {
  Json out = Json::array();
  for (const auto& of_run : c.differences) out.push_back(judged_json(of_run[p]));
  return out;
}

/// Returns for every mode of the first run what the later ones have of it.
Json modes_json(const Comparison& c) {
  Json out = Json::array();
  for (std::size_t i = 0; i < c.runs.front().modes.modes.size(); ++i) {
    Json differences = Json::array();
    for (const auto& of_run : c.modes) {
      const ModeDifference& d = of_run[i];
      differences.push_back({{"mode", d.later < 0 ? Json() : Json(d.later + 1)},
                             {"frequency", judged_json(d.frequency)},
                             {"damping", size_json(d.damping)},
                             {"mac", json_value(d.mac)}});
    }
    out.push_back({{"mode", i + 1}, {"differences", std::move(differences)}});
  }
  return out;
}

/// Returns the differences of the peak drifts by story of the first run.
Json drifts_json(const Comparison& c) {
  Json out = Json::array();
  if (!c.runs.front().report.drifts) return out;
  const auto& stories = c.runs.front().report.drifts->drifts;
  for (std::size_t s = 0; s < stories.size(); ++s) {
    Json differences = Json::array();
    for (const auto& of_run : c.drifts) differences.push_back(size_json(of_run[s]));
    out.push_back({{"story", stories[s].story}, {"differences", std::move(differences)}});
  }
  return out;
}

Json parameters_json(const Comparison& c) {
  Json out = Json::array();
  const parameter_table_t& table = c.runs.front().table();
  for (std::size_t p = 0; p < table.name.size(); ++p) {
    Json values = Json::array();
    for (const ComparedRun& run : c.runs)
      values.push_back({{"value", json_value(run.values[p].value)},
                        {"std_error", json_value(run.values[p].std_error)},
                        {"windows", run.values[p].count}});
    out.push_back({{"name", table.name[p]},
                   {"place", place_of(c.runs.front().report, p)},
                   {"unit", table.unit[p]},
                   {"values", std::move(values)},
                   {"differences", differences_of(c, p)}});
  }
  return out;
}

Json run_json(const ComparedRun& run) {
  Json drifts = Json::array(), transfer = Json::array(), modes = Json::array();
  if (run.report.drifts)
    for (const estimator::StoryDrift& d : run.report.drifts->drifts)
      drifts.push_back({{"story", d.story},
                        {"drift_ratio", json_value(d.ratio)},
                        {"std_error", json_value(d.std_error)}});
  for (const RunMode& mode : run.modes.modes)
    modes.push_back({{"frequency_hz", json_value(mode.natural.frequency_hz)},
                     {"frequency_std_error_hz", json_value(mode.natural.frequency_error_hz)},
                     {"damping_ratio", json_value(mode.natural.damping_ratio)},
                     {"damping_std_error", json_value(mode.natural.damping_error)},
                     {"motion", motion_words(mode.natural)},
                     {"measured_hz", json_value(mode.measured_hz)},
                     {"measured_damping_ratio", json_value(mode.measured_damping_ratio)},
                     {"mac_measured", json_value(mode.mac_measured)}});
  for (const TransferFunction& t : run.transfer())
    transfer.push_back({{"direction", letter(t.direction)},
                        {"mode_hz", json_value(t.measured_mode_hz)},
                        {"segments", t.segments}});
  return {{"name", run.name},
          {"source", run.what},
          {"structure", run.table().structure},
          {"config_sha256", run.table().config_sha256},
          {"modes", std::move(modes)},
          {"drifts", std::move(drifts)},
          {"transfer", std::move(transfer)}};
}

constexpr int kWide = 14;  // columns of a value

/// Returns "second", or "run 3" among several.
std::string run_title(const Comparison& c, std::size_t run) {
  return c.runs.size() == 2 ? "second" : fmt::format("run {}", run + 1);
}

/// Returns the columns of a later run's value and its difference.
std::string later_text(const std::string& value, const Difference& d) {
  return fmt::format("  {:>{}}  {:>8}  {:>6}{}", value, kWide, or_dash(100 * d.ratio, "{:+.2f}"),
                     or_dash(d.errors(), "{:.1f}"), d.different ? " *" : "");
}

/// Returns the titles of these columns for all runs, after the first column.
std::string head_text(const Comparison& c, const std::string& first, int width) {
  std::string out = fmt::format("\n{:{}}  {:>{}}", first, width, "first", kWide);
  for (std::size_t r = 1; r < c.runs.size(); ++r)
    out += fmt::format("  {:>{}}  {:>8}  {:>6}", run_title(c, r), kWide, "diff., %", "errors");
  return out;
}

std::string parameters_text(const Comparison& c) {
  std::size_t longest = 0;
  const SessionReport& first = c.runs.front().report;
  for (std::size_t p = 0; p < c.runs.front().values.size(); ++p)
    longest = std::max(longest, place_of(first, p).size());
  constexpr int kUnit = 14;
  const int width = static_cast<int>(longest) + 2 + kUnit;
  std::string out = head_text(c, fmt::format("{:{}}  unit", "place", longest), width) + "\n";
  for (std::size_t p = 0; p < c.runs.front().values.size(); ++p) {
    const auto [factor, unit] = first.units.of(c.runs.front().table().kind[p]);
    out += fmt::format("{:{}}  {:{}}  {:>{}}", place_of(first, p), longest, unit, kUnit,
                       or_dash(factor * c.runs.front().values[p].value, "{:.5g}"), kWide);
    for (std::size_t r = 0; r < c.differences.size(); ++r)
      out += later_text(or_dash(factor * c.runs[r + 1].values[p].value, "{:.5g}"),
                        c.differences[r][p]);
    out += "\n";
  }
  return out;
}

/// Returns three rows for each mode: frequency, damping ratio and MAC.
std::string modes_text(const Comparison& c) {
  const std::vector<std::size_t> known = c.known_modes();
  if (known.empty()) return "";
  constexpr int kPlace = 34;
  std::string out = head_text(c, "mode", kPlace) + "\n";
  for (const std::size_t i : known) {
    const estimator::NaturalMode& first = c.runs.front().modes.modes[i].natural;
    const auto begin = [&](const char* what, const std::string& value) {
      return fmt::format("{:{}}  {:>{}}",
                         fmt::format("{} ({}), {}", i + 1, motion_words(first), what), kPlace,
                         value, kWide);
    };
    std::string frequency = begin("frequency, Hz", or_dash(first.frequency_hz, "{:.4f}"));
    std::string damping = begin("damping ratio, %", or_dash(100 * first.damping_ratio, "{:.3f}"));
    std::string mac = begin("MAC", "");
    for (std::size_t r = 0; r < c.modes.size(); ++r) {
      const ModeDifference& d = c.modes[r][i];
      const estimator::NaturalMode* later =
          d.later < 0 ? nullptr
                      : &c.runs[r + 1].modes.modes[static_cast<std::size_t>(d.later)].natural;
      frequency +=
          later_text(or_dash(later ? later->frequency_hz : estimator::kNaN, "{:.4f}"), d.frequency);
      damping += later_text(
          or_dash(100 * (later ? later->damping_ratio : estimator::kNaN), "{:.3f}"), d.damping);
      mac += later_text(or_dash(d.mac, "{:.4f}"), {estimator::kNaN, estimator::kNaN});
    }
    out += frequency + "\n" + damping + "\n" + mac + "\n";
  }
  return out;
}

std::string drifts_text(const Comparison& c) {
  if (!c.runs.front().report.drifts) return "";
  std::string out = head_text(c, "peak story drift, mm", 20) + "\n";
  const auto& stories = c.runs.front().report.drifts->drifts;
  for (std::size_t s = 0; s < stories.size(); ++s) {
    out += fmt::format("{:20}  {:>{}}", fmt::format("story {}", stories[s].story),
                       or_dash(drift_mm(c.runs.front(), stories[s].story).value, "{:.4g}"), kWide);
    for (std::size_t r = 0; r < c.drifts.size(); ++r)
      out += later_text(or_dash(drift_mm(c.runs[r + 1], stories[s].story).value, "{:.4g}"),
                        c.drifts[r][s]);
    out += "\n";
  }
  return out;
}

/// Returns for each run and direction the peak of the measured transfer function.
std::string transfer_text(const Comparison& c) {
  std::string out;
  for (const ComparedRun& run : c.runs)
    for (const TransferFunction& t : run.transfer())
      out += fmt::format("{:20}  {:>9}  {:>14}  {:>8}\n", run.name, letter(t.direction),
                         or_dash(t.measured_mode_hz, "{:.3f}"), t.segments);
  if (out.empty()) return out;
  return fmt::format("\n{:20}  {:>9}  {:>14}  {:>8}\n", "transfer function", "direction",
                     "first peak, Hz", "segments") +
         out;
}

}  // namespace

std::string comparison_json(const Comparison& c) {
  Json out{{"schema", "framewatch.compare/1"},
           {"version", FRAMEWATCH_VERSION},
           {"verdict", verdict_sentences(c)},
           {"different", c.different()},
           {"judged", c.judged()},
           {"limits",
            {{"frame_ratio", c.limits.least(0)},
             {"panel_ratio", c.limits.least(1)},
             {"frequency_ratio", c.limits.least_frequency()},
             {"std_errors", c.limits.errors}}},
           {"notes", c.notes},
           {"runs", Json::array()},
           {"parameters", parameters_json(c)},
           {"modes", modes_json(c)},
           {"drifts", drifts_json(c)}};
  for (const ComparedRun& run : c.runs) out["runs"].push_back(run_json(run));
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string comparison_text(const Comparison& c) {
  std::string out;
  for (const std::string& sentence : verdict_sentences(c)) out += sentence + "\n";
  out += parameters_text(c) + modes_text(c) + drifts_text(c) + transfer_text(c);
  if (!c.notes.empty()) out += "\n";
  for (const std::string& note : c.notes) out += note + "\n";
  return out;
}

}  // namespace framewatch::daemon
