// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "daemon/config/config.h"
#include "daemon/monitor/history/history_days.h"
#include "daemon/monitor/history/history_request.h"
#include "daemon/monitor/history/summary_query.h"
#include "daemon/monitor/history/weather_effects.h"
#include "daemon/monitor/history/weather_table.h"
#include "estimator/years/life_budget.h"
#include "estimator/years/years_watch.h"

namespace framewatch::daemon {

/// Returns the covariates that years are watched with: those with a reading within the first 30
/// days or the first quarter of the days from `first_day` to `to_day`, and within the last year. A
/// covariate that came later would cost all the days before it. `to_day` is excluded.
std::vector<WeatherSpan> lasting_covariates(const std::vector<WeatherSpan>& spans,
                                            std::int64_t first_day, std::int64_t to_day);

/// Returns the covariates that a history keeps for the days of these elements.
WeatherTable kept_weather(const HistoryRequest& request, SummaryQuery& summaries,
                          const std::vector<ElementDays>& elements);

/// Returns the start of the first summary. Skips summaries a year or more before the others: a
/// clock was not set.
std::optional<std::int64_t> first_summary(SummaryQuery& summaries, std::int64_t period_s);

/// Finds losses in the daily means of a history as it grows, with the result of find_losses() over
/// all days so far. Begins again from the first day when an element or a covariate joins or leaves,
/// and when maintenance becomes known later.
class LossFollower {
 public:
  /// window_s: length of the windows. period_s: of the summaries that are read.
  LossFollower(Quantity quantity, const estimator::LifeBudget& budget, double window_s,
               std::int64_t period_s);

  struct Loss {
    std::string element;  ///< or kWholeBuilding
    estimator::YearsWatch::Finding finding;
  };
  /// Takes the days before `to_day` (since 1970, UTC) that it has not taken. Returns the losses
  /// found in them, or nullopt if the history cannot be read (see `problem`) or `stop` returned
  /// true; then the next call begins with the first day.
  std::optional<std::vector<Loss>> advance(SummaryQuery& summaries, std::int64_t to_day,
                                           const std::function<bool()>& stop, std::string& problem);

  int days() const { return watch_ ? watch_->days() : 0; }

  /// Returns what the weather does to every element, as far as the days taken so far tell. Empty
  /// without keep_weather(), and before there is a day with values.
  WeatherEffects weather_effects() const;
  /// Keeps the weather of every day for weather_effects(). Call it before advance().
  void keep_weather() { keeps_weather_ = true; }

 private:
  bool begin(SummaryQuery& summaries, std::int64_t to_day);
  void take(SummaryQuery& summaries, std::int64_t from_day, std::int64_t to_day,
            const std::function<bool()>& stop, std::vector<Loss>& found);

  Quantity quantity_;
  estimator::LifeBudget budget_;
  double window_s_;
  std::int64_t period_s_;
  std::vector<SummaryParameter> elements_;
  std::vector<std::string> covariates_;
  std::vector<std::int64_t> maintenance_days_;  ///< since 1970, UTC
  std::optional<estimator::YearsWatch> watch_;
  std::int64_t next_day_ = 0;
  bool keeps_weather_ = false;
  std::map<std::int64_t, Eigen::VectorXd> weather_;  ///< regressors by day
};

/// Returns a follower of a history. `config` has [history]; without [watch] the budget is the
/// default. Reads hours if the history has some, otherwise its longest summaries.
LossFollower follower_of(Quantity quantity, const Config& config);

}  // namespace framewatch::daemon
