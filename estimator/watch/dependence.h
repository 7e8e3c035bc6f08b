#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "estimator/identify/estimate/estimate.h"
#include "estimator/watch/baseline.h"
#include "estimator/watch/separate_windows.h"

namespace framewatch::estimator {

/// What an intact building's stiffness may depend on: temperature, degC, and the logarithm of the
/// amplitude of the element's own motion.
struct Conditions {
  double degc;
  double log_amplitude;
};

/// How a baseline's values follow the conditions, relative to the value, per degC and per unit of
/// the logarithm. Theta order.
class Dependence {
 public:
  Dependence() = default;
  explicit Dependence(std::size_t parameters);

  struct Expected {
    double ratio;      ///< to the baseline's value
    double std_error;  ///< of that, from the slopes'; infinite when a condition is not known
  };
  Expected expected(std::size_t parameter, const Conditions& now) const;
  /// Whether it is one of so many parameters.
  bool is_of(std::size_t parameters) const {
    return at_.size() == 2 * parameters && slope_.size() == 2 * parameters &&
           covariance_.size() == 3 * parameters;
  }
  /// Relative change per degC, and per unit of the logarithm of the amplitude; 0 +- 0 when it is
  /// not followed.
  struct Slope {
    double value, std_error;
  };
  Slope per_degc(std::size_t parameter) const;
  Slope per_log(std::size_t parameter) const;
  /// By how much the ratio usually changes per degC: the slope and its error.
  double usual_per_degc(std::size_t parameter) const;
  /// From one temperature to another.
  Expected change(std::size_t parameter, double from_degc, double to_degc) const;

  template <typename Archive>
  void archive(Archive& a) {
    for (std::vector<double>* of : {&at_, &slope_, &covariance_}) a.any_size(*of);
  }

 private:
  friend class DependenceLearner;
  std::vector<double> at_, slope_;  ///< (degC, logarithm) of every parameter
  std::vector<double> covariance_;  ///< of the two slopes: 00, 11, 01 of every parameter
};

struct DependenceOptions {
  double learn_s = 86400;  ///< sum of the windows it takes
  bool temperature = false, amplitude = false;
};

/// Learns a baseline from long windows that do not overlap, and how it depends on the conditions:
/// least squares weighted by 1 / std_error^2, with a weak prior of zero slope, so that a slope that
/// the conditions did not show has an error that says so. Errors follow from the weights, or from
/// the scatter about the fit if that is larger.
class DependenceLearner {
 public:
  /// What a slope may be before anything is known: standard deviations.
  static constexpr double kUsualPerDegc = 0.005, kUsualPerLog = 0.05;

  DependenceLearner(int parameters, const DependenceOptions& options);

  /// degc: mean of the window; NaN: not known. A window without the temperature asked for does not
  /// count. True when this one completed the baseline.
  bool push(const WindowEstimate& estimate, double degc);
  bool complete() const { return windows_.seconds() >= options_.learn_s; }
  double learned_s() const { return windows_.seconds(); }
  Baseline baseline() const;
  Dependence dependence() const;

  static double log_amplitude(const WindowEstimate& estimate, std::size_t parameter);

  template <typename Archive>
  void archive(Archive& a) {
    a(windows_, sums_);
  }

 private:
  struct Sum {
    int count = 0;
    double first = 0, first_degc = 0, first_log = 0;
    std::array<double, 6> normal{};  ///< of (1, degC, log): 00 01 02 11 12 22
    std::array<double, 3> right{};
    double square = 0;

    template <typename Archive>
    void archive(Archive& a) {
      a.within(count, 0, a.kMaxCount);
      a.finite(first, first_degc, first_log, normal, right, square);
    }
  };
  struct Fit {
    double value, std_error;  ///< at the mean conditions
    std::array<double, 2> at, slope;
    std::array<double, 3> covariance;
  };
  Fit fit(const Sum& sum) const;

  DependenceOptions options_;
  SeparateWindows windows_;
  std::vector<Sum> sums_;
};

}  // namespace framewatch::estimator
