// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "estimator/years/life_budget.h"
#include "estimator/years/loss_evidence.h"
#include "estimator/years/sensor_suspicions.h"
#include "estimator/years/weather_lags.h"

namespace framewatch::estimator {

/// A day's value of one element: its stiffness, and the standard error; NaN: no value.
struct DayValue {
  double value, std_error;  ///< N/m, or another unit, the same every day
};

/// Collects the values of a day. The error of their mean is the larger of what their own errors and
/// their scatter say.
class DayMean {
 public:
  void push(double value, double std_error);
  DayValue mean() const;

 private:
  int count_ = 0;
  double first_ = 0, weight_ = 0, sum_ = 0, square_ = 0;  ///< sums of values minus the first
};

/// Watches a building's stiffness for years by its daily means: one element against the others,
/// which cancels the weather that all feel, and all of them together.
class YearsWatch {
 public:
  static constexpr int kAllAlike = -1;

  YearsWatch(std::size_t elements, const std::vector<Covariate>& covariates,
             const LifeBudget& budget);

  struct Finding {
    int element;       ///< or kAllAlike
    double found_day;  ///< day of the value that completed the evidence
    double since_day;  ///< day of the first value after the loss
    double ratio;      ///< change of the stiffness, relative; below 0
    double std_error;
  };
  /// Takes a day later than the one before. values: by element. weather: by covariate, NaN: not
  /// known. A value far from the element's others is left out unless it comes again and again.
  /// Returns the loss that this day's values prove, if any. It then counts as known, and the
  /// watch goes on for further ones.
  std::optional<Finding> push(double day, const std::vector<DayValue>& values,
                              const std::vector<double>& weather);

  /// Forgets the level of every element, because the building was changed on purpose, by an unknown
  /// amount, between the day before and the next one. Keeps what was learned of the weather. Losses
  /// that are not proven yet are forgotten too.
  void begin_anew();

  /// Returns the evidence of a loss of an element or kAllAlike: the logarithm of the capital (see
  /// LossEvidence) over the one that proves it; 1: proven.
  double evidence(int element) const;
  /// Returns the most likely loss, proven or not, of which evidence() speaks.
  LossEvidence::Step step(int element) const { return series(element).step(); }
  int days() const { return days_; }
  /// Returns the sensor of weather that is probably wrong for good, if any. What it explains does
  /// not count as a loss.
  std::optional<SensorSuspicions::Wrong> wrong_sensor() const { return sensors_.wrong(); }

  /// Returns what weather does to the logarithm of an element's stiffness, by regressor(), as far
  /// as the days so far tell. The first one, of the level, is 0.
  Eigen::VectorXd weather_effect(std::size_t element) const;
  /// Returns the weather of the newest day, as WeatherLags has it; empty before every covariate has
  /// a value.
  Eigen::VectorXd regressors() const;

 private:
  struct Element {
    std::vector<double> first;     ///< logarithms of the first values
    bool known = false;            ///< has a reference
    bool near = false;             ///< a later value was near the first ones
    int away = 0;                  ///< values in a row that were far from them and near each other
    double far = 0;                ///< logarithm of the last one
    double reference = 0;          ///< logarithm of the value that counts as 0, with known losses
    double usual = 0;              ///< running mean of its difference from all
    double now = 0, variance = 0;  ///< of the present day, logarithms
  };
  const LossEvidence& series(int element) const;
  bool take(double days, const std::vector<DayValue>& values);
  void leave_out(std::vector<DayValue>& values);

  std::vector<Element> elements_;
  WeatherLags weather_;
  SensorSuspicions sensors_;
  std::vector<LossEvidence> series_;  ///< elements against the others, then all of them
  double proof_;  ///< logarithm of the odds that prove a loss, or a sensor's error
  int days_ = 0;
  double last_day_ = 0;
  double all_ = 0;  ///< mean of the elements' logarithms on that day, over their references
};

}  // namespace framewatch::estimator
