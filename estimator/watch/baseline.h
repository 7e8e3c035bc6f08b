// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "estimator/identify/estimate/estimate.h"
#include "estimator/numeric/nan.h"
#include "estimator/watch/amplitude_curve.h"
#include "estimator/watch/watched.h"

namespace framewatch::estimator {

/// Reference values that changes are judged against: theta order, SI; NaN: not known.
struct Baseline {
  Baseline() = default;
  explicit Baseline(std::size_t parameters);
  std::vector<double> value, std_error;
  std::vector<double> degc;  ///< mean temperature at which it was learned; NaN: not known
  /// Values by RecentAmplitude of the element, ascending, at most AmplitudeBins::kBins; empty: not
  /// known.
  std::vector<std::vector<AmplitudePoint>> by_amplitude;

  bool knows(std::size_t parameter) const;
  /// Returns the number of parameters it knows.
  int known() const;
  /// Returns true if it has the same value for every parameter that `other` knows.
  bool holds(const Baseline& other) const;
  /// Returns true if it has this many parameters.
  bool is_of(std::size_t parameters) const {
    return value.size() == parameters && std_error.size() == parameters &&
           degc.size() == parameters && by_amplitude.size() == parameters;
  }

  /// Returns by_amplitude as numbers: for every parameter the number of points, then the points.
  std::vector<double> flat_points() const;
  /// Reads by_amplitude from flat_points(). Returns false when `numbers` are invalid.
  [[nodiscard]] bool take_points(const std::vector<double>& numbers);

  void archive(auto& a) {
    for (std::vector<double>* of : {&value, &std_error, &degc}) a.any_size(*of);
    std::vector<double> points = flat_points();
    a.any_size(points);
    if (a.kReading)
      if (!take_points(points)) a.refuse();
  }
};

/// Learns a baseline while the building is intact: the mean of the main windows that count and do
/// not overlap, weighted by 1 / std_error^2, overall and by amplitude. Its error follows from the
/// weights, or from the scatter of the windows that amplitude does not explain, if that is larger.
/// Each parameter is learned separately until the error of its baseline is small compared with the
/// least relevant change; in weak motion that takes longer.
class BaselineLearner {
 public:
  /// Standard error of a learned baseline over the least relevant change.
  static constexpr double kExact = 0.1;

  /// watched: theta order. learn_s: least total length of the windows of every parameter.
  /// amplitude: learn values by amplitude, too.
  BaselineLearner(const std::vector<Watched>& watched, double learn_s, bool amplitude = true);

  /// Returns a learner that averages any number of windows.
  static BaselineLearner of_any_windows(std::size_t parameters) {
    return {std::vector<Watched>(parameters), std::numeric_limits<double>::infinity()};
  }

  /// Adds a window. degc: its temperature; NaN: unknown. Returns true when it completed a
  /// parameter.
  bool push(const WindowEstimate& estimate, double degc = kNaN);
  /// Returns the total length of the windows so far, s, whether or not they had values.
  double seconds() const { return windows_.seconds(); }
  /// Returns the completed parameters.
  Baseline baseline() const;
  /// Returns the parameters of which at least half of the windows had a value that counts, however
  /// inexact.
  Baseline so_far() const;

  void archive(auto& a) { a(windows_, sums_, recent_); }

 private:
  struct Sum {
    bool complete = false;
    int count = 0;
    double learned_s = 0;
    double weight = 0, value = 0, square = 0;  ///< values minus the first one
    double first = 0;
    double degc_weight = 0, degc = 0;
    int with_amplitude = 0;  ///< of count
    AmplitudeBins bins;

    void archive(auto& a) {
      a(complete);
      a.within(count, 0, a.kMaxCount);
      a.within(with_amplitude, 0, count);
      a(bins);
      a.finite(learned_s, weight, value, square, first, degc_weight, degc);
    }
  };
  struct Mean {
    double value, std_error, degc;
  };
  static Mean mean(const Sum& sum);
  static void put(const Sum& sum, std::size_t parameter, Baseline& out);
  void remember(const WindowEstimate& estimate);
  bool enough(std::size_t parameter) const;

  std::vector<Watched> watched_;
  double learn_s_;
  bool amplitude_;
  SeparateWindows windows_;
  std::vector<Sum> sums_;
  std::vector<RecentAmplitude> recent_;  ///< of main windows
};

}  // namespace framewatch::estimator
