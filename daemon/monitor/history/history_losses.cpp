// SPDX-License-Identifier: MIT
#include "daemon/monitor/history/history_losses.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/base/clocks.h"
#include "daemon/base/numbers.h"
#include "daemon/base/utc_time.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {
namespace {

constexpr std::int64_t kHour_s = 3600;
constexpr double kWindow_s = 5;  // if no configuration says the length
constexpr double kLikely = 0.3;  // evidence from which a loss is shown before it is proven
constexpr const char* kAll = "all alike";

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

std::string day_text(double day) {
  return utc_text(static_cast<std::int64_t>(day) * kDay_us).substr(0, 10);
}

std::string element_name(const HistoryLosses& l, int element) {
  return element == estimator::YearsWatch::kAllAlike
             ? kAll
             : l.elements[static_cast<std::size_t>(element)];
}

std::string change_text(double ratio, double std_error) {
  return fmt::format("{} %", change_with_error(ratio, std_error));
}

}  // namespace

HistoryLosses find_losses(const HistoryRequest& r, SummaryQuery& summaries,
                          const WeatherTable& weather) {
  HistoryLosses out;
  const std::int64_t period_s = period_of(summaries);
  const double window_s = r.config ? r.config->pipeline.options.window_s : kWindow_s;
  std::map<std::int64_t, std::map<std::size_t, estimator::DayMean>> days;
  std::vector<std::vector<double>> values;
  for (const SummaryParameter& p : r.parameters) {
    if (!p.name.starts_with("kx_") && !p.name.starts_with("ky_")) continue;
    std::vector<double> of_parameter;
    for (const SummaryRow& row : summaries.rows(p.id, period_s, r.from_us, r.to_us)) {
      if (row.observable <= 0 || !std::isfinite(row.mean)) continue;
      of_parameter.push_back(row.mean);
      days[row.start_us / kDay_us][out.elements.size()].push(
          row.mean, error_of_mean(row, period_s, window_s));
    }
    if (of_parameter.empty()) continue;
    out.elements.push_back(p.name);
    values.push_back(std::move(of_parameter));
  }
  for (const estimator::Covariate& c : weather.covariates) out.covariates.push_back(c.name);
  if (days.empty()) return out;
  out.from_us = days.begin()->first * kDay_us;
  out.to_us = days.rbegin()->first * kDay_us;

  estimator::YearsWatch watch(out.elements.size(), weather.covariates, estimator::LifeBudget{});
  for (std::int64_t day = days.begin()->first; day <= days.rbegin()->first; ++day) {
    std::vector<estimator::DayValue> of_day(out.elements.size(), estimator::DayMean().mean());
    if (const auto found = days.find(day); found != days.end())
      for (const auto& [element, mean] : found->second) of_day[element] = mean.mean();
    if (const auto loss = watch.push(static_cast<double>(day), of_day, weather.of(day)))
      out.found.push_back(*loss);
  }
  out.days = watch.days();
  for (std::size_t p = 0; p < out.elements.size(); ++p)
    out.state.push_back(
        {median(values[p]), watch.evidence(static_cast<int>(p)), watch.step(static_cast<int>(p))});
  constexpr int kAllAlike = estimator::YearsWatch::kAllAlike;
  out.state.push_back({estimator::kNaN, watch.evidence(kAllAlike), watch.step(kAllAlike)});
  return out;
}

std::string losses_text(const HistoryLosses& l) {
  if (l.elements.empty()) return "no hour with a value of a frame's stiffness\n";
  std::string with;
  for (const std::string& name : l.covariates) with += (with.empty() ? "" : ", ") + name;
  const estimator::LifeBudget budget;
  std::string out = fmt::format(
      "{} with values, {} to {}; weather: {}\n{} of at least {:.0f} % that weather does not "
      "explain; a false one in {:.0f} years has a probability of {:.0f} %\n",
      l.days == 1 ? "1 day" : fmt::format("{} days", l.days),
      day_text(static_cast<double>(l.from_us / kDay_us)),
      day_text(static_cast<double>(l.to_us / kDay_us)),
      with.empty() ? "not known, the season stands for it" : with,
      l.found.empty()       ? "no loss"
      : l.found.size() == 1 ? "1 loss"
                            : fmt::format("{} losses", l.found.size()),
      100 * budget.least_loss, budget.years, 100 * budget.probability);
  for (const auto& f : l.found)
    out +=
        fmt::format("  {} {}, since {}, found {}{}\n", element_name(l, f.element),
                    change_text(f.ratio, f.std_error), day_text(f.since_day), day_text(f.found_day),
                    f.element == estimator::YearsWatch::kAllAlike
                        ? ". A change of all frames may also be a mass, or weather that is not "
                          "measured"
                        : "");
  out += fmt::format("\n{:<12} {:>12} {:>9}  {}\n", "element", "median", "evidence", "most likely");
  for (std::size_t p = 0; p < l.state.size(); ++p) {
    const HistoryLosses::State& s = l.state[p];
    const bool all = p == l.elements.size();
    out +=
        fmt::format("{:<12} {:>12} {:>7.0f} %  {}\n", all ? kAll : l.elements[p],
                    all ? "" : fmt::format("{:.5g} N/m", s.median), 100 * s.evidence,
                    s.evidence < kLikely ? "no loss"
                                         : change_text(std::expm1(s.step.size), s.step.std_error) +
                                               " since " + day_text(s.step.day));
  }
  return out;
}

std::string losses_json(const HistoryLosses& l) {
  using nlohmann::ordered_json;
  ordered_json out{{"schema", "framewatch.losses/1"},
                   {"days", l.days},
                   {"weather", l.covariates},
                   {"losses", ordered_json::array()},
                   {"elements", ordered_json::array()}};
  for (const auto& f : l.found)
    out["losses"].push_back({{"parameter", element_name(l, f.element)},
                             {"ratio", f.ratio},
                             {"std_error", f.std_error},
                             {"since", day_text(f.since_day)},
                             {"found", day_text(f.found_day)}});
  for (std::size_t p = 0; p < l.state.size(); ++p)
    out["elements"].push_back({{"parameter", p == l.elements.size() ? kAll : l.elements[p].c_str()},
                               {"evidence", l.state[p].evidence},
                               {"ratio", std::expm1(l.state[p].step.size)},
                               {"std_error", l.state[p].step.std_error}});
  return out.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace framewatch::daemon
