// SPDX-License-Identifier: MIT
#include "daemon/monitor/history/history_days.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/numbers.h"
#include "daemon/base/utc_time.h"

namespace framewatch::daemon {
namespace {

constexpr std::int64_t kHour_s = 3600;
constexpr double kWindow_s = 5;    // if no configuration says the length
constexpr std::size_t kDate = 10;  // characters

/// Returns the summaries' period to read: hours if there are some, otherwise the longest.
std::int64_t period_of(SummaryQuery& summaries) {
  std::int64_t longest_s = 0;
  for (const SummaryPeriods& p : summaries.periods()) {
    if (p.period_s == kHour_s) return kHour_s;
    longest_s = std::max(longest_s, p.period_s);
  }
  return longest_s;
}

/// Returns the standard error of a period's mean: windows overlap, so it shows as many independent
/// ones as fit into the time with values.
double error_of_mean(const SummaryRow& row, std::int64_t period_s, double window_s) {
  const double shown_s = static_cast<double>(period_s) * static_cast<double>(row.observable) /
                         static_cast<double>(std::max<std::int64_t>(row.windows, 1));
  return row.std_error * std::sqrt(std::min(1.0, window_s / std::max(shown_s, 1e-3)));
}

struct Hours {
  estimator::DayMean mean;
  std::vector<double> q1, median, q3;
  std::int64_t windows = 0, observable = 0;
};

}  // namespace

double ElementDays::usual() const {
  std::vector<double> medians;
  for (const auto& [day, of_day] : days) medians.push_back(of_day.median);
  return median(std::move(medians));
}

std::vector<ElementDays> read_days(const HistoryRequest& r, SummaryQuery& summaries) {
  const std::int64_t period_s = period_of(summaries);
  const double window_s = r.config ? r.config->pipeline.options.window_s : kWindow_s;
  std::vector<ElementDays> out;
  for (const SummaryParameter& p : r.parameters) {
    if (!p.name.starts_with("kx_") && !p.name.starts_with("ky_")) continue;
    std::map<std::int64_t, Hours> days;
    for (const SummaryRow& row : summaries.rows(p.id, period_s, r.from_us, r.to_us)) {
      Hours& of_day = days[row.start_us / kDay_us];
      of_day.windows += row.windows;
      if (row.observable <= 0 || !std::isfinite(row.mean)) continue;
      of_day.observable += row.observable;
      of_day.mean.push(row.mean, error_of_mean(row, period_s, window_s));
      of_day.q1.push_back(row.q1);
      of_day.median.push_back(row.median);
      of_day.q3.push_back(row.q3);
    }
    ElementDays element{p.name, {}};
    for (auto& [day, h] : days)
      if (h.observable > 0)
        element.days.emplace(
            day, DayOfElement{h.mean, median(std::move(h.q1)), median(std::move(h.median)),
                              median(std::move(h.q3)),
                              static_cast<double>(h.observable) /
                                  static_cast<double>(std::max<std::int64_t>(h.windows, 1))});
    if (!element.days.empty()) out.push_back(std::move(element));
  }
  return out;
}

std::string day_text(std::int64_t day) {
  return utc_text(day * kDay_us).substr(0, kDate);
}

std::string days_text(int days) {
  return days == 1 ? "1 day" : fmt::format("{} days", days);
}

}  // namespace framewatch::daemon
