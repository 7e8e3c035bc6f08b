// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "estimator/state/archive.h"

namespace framewatch::estimator {

/// The mean of a parameter's values at one amplitude of its element.
struct AmplitudePoint {
  double amplitude_m;  ///< rms deformation, > 0
  double value;        ///< SI
  double std_error;    ///< SI, > 0

  bool valid() const { return amplitude_m > 0 && value > 0 && std_error > 0; }
};

/// The dependence of an intact element's stiffness on the amplitude of its motion: a smooth curve
/// over the logarithm of the amplitude. The error grows where nothing was learned, and only to the
/// side that softening with amplitude explains. The prior of the slope is 0 +- kUsualPerLog, and it
/// bends by kBend per square root of a unit of the logarithm (Wahba, J. R. Stat. Soc. B 40, 1978,
/// 364: a smoothing spline as the mean of an integrated random walk). docs/equations.md, changes.
class AmplitudeCurve {
 public:
  static constexpr double kUsualPerLog = 0.035, kBend = 0.03;
  /// A curve needs a highest amplitude of at least kSpan times the lowest. Otherwise the baseline's
  /// value holds, because a slope would be mostly noise.
  static constexpr double kSpan = 3;

  AmplitudeCurve() = default;  ///< not known()
  /// value: the parameter's baseline > 0; own_error: its standard error, relative. points: at most
  /// AmplitudeBins::kBins; without points the curve is not known().
  AmplitudeCurve(double value, double own_error, const std::vector<AmplitudePoint>& points);

  bool known() const { return !at_.empty(); }
  struct Expected {
    double ratio;      ///< to the baseline's value
    double std_error;  ///< of the ratio, including the error of the value itself
  };
  /// Precondition: known(); amplitude_m > 0.
  Expected expected(double amplitude_m) const;
  /// Return the least and the largest credible ratio: `errors` standard errors from the expected
  /// one, beyond as many of the value itself. Below the lowest amplitude learned, least() is that
  /// at the lowest; above the highest, most() is that at the highest.
  double least(double amplitude_m, double errors) const;
  double most(double amplitude_m, double errors) const;
  bool spans() const;
  /// Returns the lowest and the highest amplitude learned from.
  double lowest_m() const;
  double highest_m() const;
  /// Returns the relative change per unit of the logarithm of the amplitude, at an amplitude.
  double slope(double amplitude_m) const;

 private:
  double covariance(double a, double b) const;
  Expected at_log(double log) const;

  double origin_ = 0;       ///< logarithm at which the slope's prior is centered
  double own_error_ = 0;    ///< of the value itself, relative
  std::vector<double> at_;  ///< logarithms of the points
  std::vector<double> weights_, inverse_;
};

/// Sums a parameter's windows by amplitude in kBins bins about the first one, each kStep of the
/// logarithm wide. The outermost bins take everything beyond.
class AmplitudeBins {
 public:
  static constexpr int kBins = 24;
  static constexpr double kStep = 0.35;

  /// amplitude_m > 0; off: the value over the first one, less 1; weight: 1 / error^2 of `off`.
  void push(double amplitude_m, double off, double weight);

  /// Returns the points of the values `first` (1 + off).
  std::vector<AmplitudePoint> points(double first) const;
  /// Returns the variance of the values about the curve over what their errors predict, >= 1; 1
  /// while there are too few values.
  double excess() const;
  bool any() const;

  void archive(auto& a) {
    a.finite(first_log_);
    a(bins_);
  }

 private:
  /// Scatter about the curve: the ratio of variances, and the relative variance that errors and
  /// chance do not explain. The latter lasts: it depends on what the element has gone through
  /// before.
  struct Scatter {
    double excess = 1, lasting = 0;
  };
  Scatter scatter() const;
  struct Bin {
    int count = 0;
    double weight = 0, log = 0, off = 0;  ///< weighted sums
    double log_square = 0, off_square = 0, log_off = 0;

    void archive(auto& a) {
      a.within(count, 0, a.kMaxCount);
      a.finite(weight, log, off, log_square, off_square, log_off);
    }
  };
  double first_log_ = 0;
  std::array<Bin, kBins> bins_{};
};

/// Keeps the recent amplitudes of an element. An amplitude fades in inverse proportion to the time
/// since, as slowly as the element recovers.
class RecentAmplitude {
 public:
  /// An amplitude counts in full for so long, then by kHolds_s over its age.
  static constexpr double kHolds_s = 20;
  static constexpr std::size_t kMax = 8;

  /// Ignores an amplitude that is older than the last one.
  void push(double time_s, double amplitude_m);
  /// Returns the last amplitude; 0: there is no amplitude yet.
  double newest() const { return count_ > 0 ? amplitude_[count_ - 1] : 0; }
  /// Returns the largest remembered amplitude; 0: there is no amplitude yet.
  double at(double time_s) const;

  void archive(auto& a) {
    a.within(count_, 0, static_cast<double>(kMax));
    a.finite(time_s_, amplitude_);
  }

 private:
  double remembered(std::size_t i, double time_s) const;

  std::size_t count_ = 0;  ///< newest last, each smaller than those before it
  std::array<double, kMax> time_s_{}, amplitude_{};
};

}  // namespace framewatch::estimator
