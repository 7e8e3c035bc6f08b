// SPDX-License-Identifier: MIT
#include "daemon/page/view/stored_history.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "daemon/monitor/history/raw_history_reader.h"
#include "daemon/monitor/history/summary_query.h"
#include "daemon/page/view/page_history.h"
#include "drivers/lcm/count_block.h"
#include "estimator/numeric/nan.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::daemon {
namespace {

using estimator::kNaN;

constexpr std::int32_t kObservable = 0, kQuiet = 2;  // window_estimate_t::reason

/// Returns an estimate without any value.
window_estimate_t empty_estimate(std::size_t parameters, std::int64_t end_us) {
  window_estimate_t e{};
  e.window_end_us = end_us;
  e.status = 1;
  e.residual_ratio = kNaN;
  e.boxplots = 1;
  e.reason.assign(parameters, kQuiet);
  clear_values(e, parameters);
  return e;
}

void show(const SummaryRow& row, std::size_t p, window_estimate_t& e) {
  e.reason[p] = kObservable;
  e.value[p] = row.mean;
  e.std_error[p] = row.std_error;
  if (row.boxed <= 0) return;
  e.q1[p] = row.q1;
  e.median[p] = row.median;
  e.q3[p] = row.q3;
  e.whisker_low[p] = row.whisker_low;
  e.whisker_high[p] = row.whisker_high;
  const auto count = [](std::int64_t n) {
    return static_cast<std::int32_t>(
        std::clamp<std::int64_t>(n, 0, std::numeric_limits<std::int32_t>::max()));
  };
  e.outliers[p] = count(row.outliers);
  e.boxplot_count[p] = count(row.boxed);
  e.boxplot_windows = std::max(e.boxplot_windows, e.boxplot_count[p]);
}

std::vector<window_estimate_t> stored_estimates(SummaryQuery& store, const Config& config,
                                                std::int64_t newest_us) {
  const estimator::ParameterTable table = config.pipeline.parameters();
  const auto parameters = static_cast<std::size_t>(table.size());
  const std::vector<SummaryPeriods> periods = store.periods();
  std::map<std::int64_t, window_estimate_t> by_end;
  if (periods.empty()) return {};
  const auto take = [&](const SummaryRow& row, std::size_t p) {
    const auto at = by_end.try_emplace(row.last_us, empty_estimate(parameters, row.last_us)).first;
    show(row, p, at->second);
  };
  const std::int64_t from_us = newest_us - static_cast<std::int64_t>(1e6 * PageHistory::kMost_s) -
                               1'000'000 * periods.front().period_s;
  for (const SummaryParameter& parameter : store.parameters()) {
    const auto p = table.find(parameter.name);
    if (!p) continue;
    for (const SummaryRow& row :
         store.rows(parameter.id, periods.front().period_s, from_us, kEver_us))
      if (row.observable > 0) take(row, static_cast<std::size_t>(*p));
    if (const auto row = store.newest_row(parameter.id, periods.front().period_s))
      take(*row, static_cast<std::size_t>(*p));
  }
  std::vector<window_estimate_t> out;
  for (auto& [end_us, estimate] : by_end) out.push_back(std::move(estimate));
  return out;
}

void read_samples(const Config& config, std::int64_t newest_us, StoredHistory& out,
                  std::vector<std::string>& notes) {
  const std::vector<estimator::SensorAxis>& axes = config.pipeline.axes;
  const double rate_hz = config.pipeline.options.rate_hz * static_cast<double>(axes.size());
  const double most_s = std::min(PageHistory::kMost_s, StoredHistory::kMaxSamples / rate_hz);
  const std::int64_t from_us = newest_us - static_cast<std::int64_t>(1e6 * most_s);
  std::vector<int> axis_of;  // by the log's channel; -1: not in this configuration
  const RawVisitor visitor{
      [&](const std::vector<std::string>& names, double) { axis_of = axes_of(names, axes); },
      [&](const RawCount& c) {
        const bool full = out.samples.size() >= 2 * StoredHistory::kMaxSamples;
        if (full || c.count == drivers::kNoCount || axis_of[c.channel] < 0) return;
        out.samples.push_back(
            {estimator::from_microseconds(c.time_us), axis_of[c.channel], c.accel_mps2()});
      }};
  std::string problem;
  if (!read_raw_history(raw_logs_between(config.history->directory, from_us, kEver_us), from_us,
                        kEver_us, visitor, notes, problem))
    notes.push_back(problem);
}

}  // namespace

StoredHistory stored_history(const Config& config, std::vector<std::string>& notes) {
  StoredHistory out;
  const std::string& directory = config.history->directory;
  SummaryQuery store;
  std::string problem = store.open(directory);
  if (problem.empty()) {
    const std::optional<std::int64_t> newest_us = store.newest_us();
    if (newest_us) {
      out.estimates = stored_estimates(store, config, *newest_us);
      read_samples(config, *newest_us, out, notes);
    }
    out.events = store.events(-kEver_us, kEver_us, StoredHistory::kMaxEvents);
    problem = store.problem();
  }
  if (!problem.empty()) notes.push_back(directory + ": " + problem);
  return out;
}

}  // namespace framewatch::daemon
