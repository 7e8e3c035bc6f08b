// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "estimator/identify/estimate/estimate.h"
#include "estimator/motion/sample.h"
#include "estimator/watch/baseline.h"
#include "estimator/watch/watched.h"

namespace framewatch::estimator {

/// Conditions that an intact building's stiffness may depend on: temperature, degC, and the
/// logarithm of the amplitude of the element's own motion.
struct Conditions {
  double degc;
  double log_amplitude;
};

/// How a baseline's values follow the conditions: relative change per degC and per unit of the
/// logarithm of the amplitude. Theta order.
class Dependence {
 public:
  Dependence() = default;
  explicit Dependence(std::size_t parameters);

  struct Expected {
    double ratio;      ///< to the baseline's value
    double std_error;  ///< of the ratio, from the slopes; infinite when a condition is not known
  };
  Expected expected(std::size_t parameter, const Conditions& now) const;
  /// Returns true if it has this many parameters.
  bool is_of(std::size_t parameters) const {
    return at_.size() == 2 * parameters && slope_.size() == 2 * parameters &&
           covariance_.size() == 3 * parameters;
  }
  /// Relative change per degC, or per unit of the logarithm of the amplitude; 0 +- 0 when the
  /// condition is not followed.
  struct Slope {
    double value, std_error;
  };
  Slope per_degc(std::size_t parameter) const;
  Slope per_log(std::size_t parameter) const;
  /// Returns how much the ratio usually changes per degC: the slope with its error.
  double usual_per_degc(std::size_t parameter) const;
  /// Returns the change from one temperature to another.
  Expected change(std::size_t parameter, double from_degc, double to_degc) const;

  void archive(auto& a) {
    for (std::vector<double>* of : {&at_, &slope_, &covariance_}) a.any_size(*of);
  }

 private:
  friend class DependenceLearner;
  std::vector<double> at_, slope_;  ///< (degC, logarithm) of every parameter
  std::vector<double> covariance_;  ///< of the two slopes: 00, 11, 01, for every parameter
};

struct DependenceOptions {
  double learn_s = 86400;  ///< total length of the windows to learn from
  bool temperature = false, amplitude = false;
};

/// Learns a baseline from long windows that do not overlap, and how it depends on the conditions:
/// least squares weighted by 1 / std_error^2. A weak prior of zero slope gives a large error to a
/// slope that the conditions did not show. Errors follow from the weights, or from the scatter
/// about the fit if that is larger.
class DependenceLearner {
 public:
  /// Standard deviations of the slopes' prior.
  static constexpr double kUsualPerDegc = 0.005, kUsualPerLog = 0.05;

  DependenceLearner(int parameters, const DependenceOptions& options);

  /// Adds a window. degc: its mean temperature; NaN: not known. Skips a window without a
  /// temperature when `options.temperature` is set. Returns true when this window completed the
  /// baseline.
  bool push(const WindowEstimate& estimate, double degc);
  bool complete() const { return windows_.seconds() >= options_.learn_s; }
  double learned_s() const { return windows_.seconds(); }
  Baseline baseline() const;
  Dependence dependence() const;

  static double log_amplitude(const WindowEstimate& estimate, std::size_t parameter);

  void archive(auto& a) { a(windows_, sums_); }

 private:
  struct Sum {
    int count = 0;
    double first = 0, first_degc = 0, first_log = 0;
    std::array<double, 6> normal{};  ///< of (1, degC, log): 00 01 02 11 12 22
    std::array<double, 3> right{};
    double square = 0;

    void archive(auto& a) {
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

/// Keeps the mean temperature of the last kBins intervals of equal length.
class MeanTemperature {
 public:
  static constexpr int kBins = 64;
  /// A reading stays valid for so many intervals when no other one arrives.
  static constexpr int kHolds = 20;

  explicit MeanTemperature(double bin_s) : bin_us_(static_cast<std::int64_t>(1e6 * bin_s)) {}

  void push(Time time, double degc);
  /// Returns the mean over the intervals from start to end. Without a reading in them, returns the
  /// newest valid one before; NaN if there is no such reading.
  double mean(Time start, Time end) const;

  void archive(auto& a) { a(bins_); }

 private:
  struct Bin {
    std::int64_t number = -1, count = 0;
    double sum = 0;

    void archive(auto& a) {
      for (std::int64_t* n : {&number, &count}) a.within(*n, -a.kMaxCount, a.kMaxCount);
      a.finite(sum);
    }
  };
  std::int64_t number_of(Time time) const { return to_microseconds(time) / bin_us_; }

  std::int64_t bin_us_;
  std::array<Bin, kBins> bins_{};
};

}  // namespace framewatch::estimator
