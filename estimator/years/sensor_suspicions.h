// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "estimator/years/loss_evidence.h"
#include "estimator/years/weather_lags.h"

namespace framewatch::estimator {

/// Suspects sensors of weather. One may be wrong for good from a day on which its readings changed:
/// somebody moved it, or it broke. Then healthy elements seem to lose stiffness, because the
/// weather was another. docs/equations.md, years.
class SensorSuspicions {
 public:
  explicit SensorSuspicions(const std::vector<Covariate>& covariates) : covariates_(covariates) {}

  /// Takes a day's weather, before the series take their values. read: the regressors of the
  /// readings, with this day. means: of the covariates.
  void push(double day, const WeatherLags& read, const std::vector<double>& means,
            std::vector<LossEvidence>& series);
  /// Returns this day's weather without the error of each suspicion.
  const std::vector<LossEvidence::Weather>& weather() const { return weather_; }
  /// Weighs the suspicions by what the series have seen. Keeps the likeliest.
  void judge(std::vector<LossEvidence>& series);
  /// Returns the logarithm of how much likelier healthy elements are if sensors may be wrong.
  double excuse() const { return excuse_; }

  struct Wrong {
    std::size_t covariate;
    double since_day;
    double size, std_error;  ///< of what it reads too much, in the covariate's unit
  };
  /// Returns the sensor that is probably wrong, if any.
  std::optional<Wrong> wrong() const { return wrong_; }

 private:
  struct Suspicion {
    std::size_t covariate;
    double day;
    double size;        ///< by which its means changed
    double variance;    ///< of usual changes
    WeatherLags right;  ///< takes its means without that change
  };
  double weigh(std::size_t index, const std::vector<LossEvidence>& series) const;

  std::vector<Covariate> covariates_;
  std::vector<Suspicion> suspicions_;
  std::vector<LossEvidence::Weather> weather_;
  double excuse_ = 0;
  std::optional<Wrong> wrong_;
};

}  // namespace framewatch::estimator
