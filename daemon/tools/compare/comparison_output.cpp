// SPDX-License-Identifier: MIT
#include <cmath>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/base/json.h"
#include "daemon/base/words.h"
#include "daemon/tools/compare/comparison.h"

namespace framewatch::daemon {
namespace {

Json differences_of(const Comparison& c, std::size_t p) {
  Json out = Json::array();
  for (const auto& of_run : c.differences)
    out.push_back({{"ratio", json_value(of_run[p].ratio)},
                   {"std_error_ratio", json_value(of_run[p].std_error)},
                   {"std_errors", json_value(of_run[p].errors())},
                   {"judged", of_run[p].judged},
                   {"different", of_run[p].different}});
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
  Json drifts = Json::array(), transfer = Json::array();
  if (run.report.drifts)
    for (const estimator::StoryDrift& d : run.report.drifts->drifts)
      drifts.push_back({{"story", d.story},
                        {"drift_ratio", json_value(d.ratio)},
                        {"std_error", json_value(d.std_error)}});
  for (const TransferFunction& t : run.report.transfer)
    transfer.push_back({{"direction", letter(t.direction)},
                        {"mode_hz", json_value(t.measured_mode_hz)},
                        {"segments", t.segments}});
  return {{"name", run.name},
          {"source", run.what},
          {"structure", run.table().structure},
          {"config_sha256", run.table().config_sha256},
          {"drifts", std::move(drifts)},
          {"transfer", std::move(transfer)}};
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
             {"std_errors", c.limits.errors}}},
           {"notes", c.notes},
           {"runs", Json::array()},
           {"parameters", parameters_json(c)}};
  for (const ComparedRun& run : c.runs) out["runs"].push_back(run_json(run));
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string comparison_text(const Comparison& c) {
  constexpr int kWide = 14;
  std::string out;
  for (const std::string& sentence : verdict_sentences(c)) out += sentence + "\n";
  std::size_t longest = 0;
  const SessionReport& first = c.runs.front().report;
  for (std::size_t p = 0; p < c.runs.front().values.size(); ++p)
    longest = std::max(longest, place_of(first, p).size());
  out += fmt::format("\n{:{}}  {:14}  {:>14}", "place", longest, "unit", "first");
  for (std::size_t r = 1; r < c.runs.size(); ++r)
    out += fmt::format("  {:>{}}  {:>8}  {:>6}",
                       c.runs.size() == 2 ? "second" : fmt::format("run {}", r + 1), kWide,
                       "diff., %", "errors");
  out += "\n";
  for (std::size_t p = 0; p < c.runs.front().values.size(); ++p) {
    const auto [factor, unit] = first.units.of(c.runs.front().table().kind[p]);
    out += fmt::format("{:{}}  {:14}  {:>14}", place_of(first, p), longest, unit,
                       or_dash(factor * c.runs.front().values[p].value, "{:.5g}"));
    for (std::size_t r = 0; r < c.differences.size(); ++r) {
      const Difference& d = c.differences[r][p];
      out += fmt::format("  {:>14}  {:>8}  {:>6}{}",
                         or_dash(factor * c.runs[r + 1].values[p].value, "{:.5g}"),
                         or_dash(100 * d.ratio, "{:+.2f}"), or_dash(d.errors(), "{:.1f}"),
                         d.different ? " *" : "");
    }
    out += "\n";
  }
  for (const std::string& note : c.notes) out += note + "\n";
  return out;
}

}  // namespace framewatch::daemon
