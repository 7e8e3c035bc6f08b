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
#include "estimator/years/damping_days.h"

namespace framewatch::daemon {
namespace {

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

estimator::DayValue ElementDays::value(std::int64_t day) const {
  const auto found = days.find(day);
  return (found == days.end() ? estimator::DayMean() : found->second.mean).mean();
}

std::int64_t floor_day(std::int64_t time_us) {
  return time_us / kDay_us - (time_us % kDay_us < 0 ? 1 : 0);
}

bool is_of_frame(Quantity quantity, const std::string& parameter) {
  const bool damping = quantity == Quantity::damping;
  return parameter.starts_with(damping ? "cx_" : "kx_") ||
         parameter.starts_with(damping ? "cy_" : "ky_");
}

estimator::DayValue watched(Quantity quantity, const estimator::DayValue& value) {
  return quantity == Quantity::damping ? estimator::as_stiffness(value) : value;
}

estimator::YearsWatch::Finding in_quantity(Quantity quantity,
                                           const estimator::YearsWatch::Finding& finding) {
  return quantity == Quantity::damping ? estimator::as_damping(finding) : finding;
}

ElementDays element_days(const SummaryParameter& parameter, SummaryQuery& summaries,
                         std::int64_t period_s, double window_s, std::int64_t from_us,
                         std::int64_t to_us) {
  std::map<std::int64_t, Hours> days;
  for (const SummaryRow& row : summaries.rows(parameter.id, period_s, from_us, to_us)) {
    Hours& of_day = days[floor_day(row.start_us)];
    of_day.windows += row.windows;
    if (row.observable <= 0 || !std::isfinite(row.mean)) continue;
    of_day.observable += row.observable;
    of_day.mean.push(row.mean, error_of_mean(row, period_s, window_s));
    of_day.q1.push_back(row.q1);
    of_day.median.push_back(row.median);
    of_day.q3.push_back(row.q3);
  }
  ElementDays out{parameter.name, {}};
  for (auto& [day, h] : days)
    if (h.observable > 0)
      out.days.emplace(day,
                       DayOfElement{h.mean, median(std::move(h.q1)), median(std::move(h.median)),
                                    median(std::move(h.q3)),
                                    static_cast<double>(h.observable) /
                                        static_cast<double>(std::max<std::int64_t>(h.windows, 1))});
  return out;
}

std::vector<ElementDays> read_days(const HistoryRequest& r, Quantity quantity,
                                   SummaryQuery& summaries) {
  const std::int64_t period_s = period_of(summaries);
  const double window_s = r.config ? r.config->pipeline.options.window_s : kWindow_s;
  std::vector<ElementDays> out;
  for (const SummaryParameter& p : r.parameters) {
    if (!is_of_frame(quantity, p.name)) continue;
    ElementDays days = element_days(p, summaries, period_s, window_s, r.from_us, r.to_us);
    if (!days.days.empty()) out.push_back(std::move(days));
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
