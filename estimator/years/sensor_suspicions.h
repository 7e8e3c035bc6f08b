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
/// weather was another. An error that is proven is subtracted from later readings.
/// docs/equations.md, years.
class SensorSuspicions {
 public:
  explicit SensorSuspicions(const std::vector<Covariate>& covariates)
      : covariates_(covariates), errors_(covariates.size()) {}

  /// Returns readings, by covariate, without the errors that are proven.
  std::vector<double> correct(std::vector<double> readings) const;

  /// Takes a day's weather, before the series take their values. read: its regressors, with this
  /// day. means: of the covariates, as correct() returns them.
  void push(double day, const WeatherLags& read, const std::vector<double>& means,
            std::vector<LossEvidence>& series);
  /// Returns this day's weather without the error of each suspicion.
  const std::vector<LossEvidence::Weather>& weather() const { return weather_; }
  /// Weighs the suspicions by what the series have seen. Keeps the likeliest.
  void judge(std::vector<LossEvidence>& series);
  /// Takes a suspicion as known if it is proven against right sensors and against every loss: the
  /// series and `read` go on without its error, and there are no others. proof: logarithm of the
  /// odds that prove it. Call it after judge().
  void adopt(double proof, WeatherLags& read, std::vector<LossEvidence>& series);
  /// Returns the logarithm of how much likelier healthy elements are if sensors may be wrong.
  double excuse() const { return excuse_; }

  struct Wrong {
    std::size_t covariate;
    double since_day;
    double size, std_error;  ///< of what it reads too much, in the covariate's unit
  };
  /// Returns the sensor that is probably wrong, if any: the one that is furthest off. One that
  /// changed back is mended if the rest is not known from 0.
  std::optional<Wrong> wrong() const;

 private:
  struct Suspicion {
    std::size_t covariate;
    double day;
    double size;        ///< by which its means changed
    double variance;    ///< of usual changes
    WeatherLags right;  ///< takes its means without that change
  };
  struct Error {
    double since_day = 0;
    double size = 0, variance = 0;  ///< of what the sensor reads too much
    bool wrong = false;
    bool changed_back = false;
  };
  double weigh(std::size_t index, const std::vector<LossEvidence>& series) const;
  std::vector<Error> with_likeliest() const;

  std::vector<Covariate> covariates_;
  std::vector<Error> errors_;  ///< proven, by covariate
  std::vector<Suspicion> suspicions_;
  std::vector<LossEvidence::Weather> weather_;
  double excuse_ = 0;
  std::optional<std::size_t> likeliest_;  ///< the suspicion that is probably true, if any
  double log_odds_ = 0;                   ///< of that one
};

}  // namespace framewatch::estimator
