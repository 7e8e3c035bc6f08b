// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace framewatch::estimator {

/// How a healthy element's stiffness may follow one measured condition.
struct Covariate {
  std::string name;
  bool freezes = false;  ///< a temperature in degC: below 0 an element may follow another slope
  /// Its units per unit of a regressor, so that one prior fits all: 10 degC, 10 % of humidity, 10
  /// m/s of wind.
  double scale = 10;
};

/// Turns daily means of weather and use into the regressors of a healthy building: every covariate
/// as it is and as a wall feels it, delayed by first-order lags of kLags_d, and what lies below
/// freezing. Without covariates, the season stands for them: two waves of a year.
class WeatherLags {
 public:
  /// Time constants of the lags, days. A thin wall follows within a day; Caltech Hall and an
  /// Algerian school lag by days to a fortnight.
  static constexpr double kLags_d[] = {0, 1, 4, 12};
  static constexpr double kYear_d = 365.2425;

  explicit WeatherLags(const std::vector<Covariate>& covariates);

  /// Number of regressors; the first is 1.
  int size() const { return static_cast<int>(regressors_.size()); }
  /// Moves on to a day. means: by covariate; NaN: not known, the last value stands for it.
  void push(double day, const std::vector<double>& means);
  const Eigen::VectorXd& regressors() const { return regressors_; }
  /// Returns how far regressors may be off because a covariate is unknown, one standard deviation;
  /// infinite before its first value.
  double doubt() const;

  /// How a covariate's means change in two days. A sensor that goes wrong within a day has changed
  /// them all after two.
  struct Change {
    double size = 0;      ///< of the newest mean; 0: not known
    double variance = 1;  ///< of such changes before
  };
  Change change(std::size_t covariate) const { return past_[covariate].change; }
  /// Takes the newest change of a covariate's mean, which began on the day before, back.
  void take_back(std::size_t covariate, double size);

 private:
  struct Past {
    bool known = false;
    double day = 0;  ///< of the newest value
    double first = 0, newest = 0;
    double lagged[4] = {}, frost = 0;
    double doubt[4] = {};               ///< standard deviations of `lagged`, of its scale
    double before_day = 0, before = 0;  ///< of the value before the newest
    Change change;
    double square = 0;  ///< running mean of the squares of changes
  };
  void set_regressors();

  std::vector<Covariate> covariates_;
  std::vector<Past> past_;
  Eigen::VectorXd regressors_;
  double day_ = 0;
  bool begun_ = false;
};

}  // namespace framewatch::estimator
