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

/// How an intact element's stiffness follows the amplitude of its own motion: a smooth curve over
/// the logarithm of the amplitude through what was learned, with an error that grows where nothing
/// was, and only to that side which softening with amplitude explains. Its slope is drawn to 0 +-
/// kUsualPerLog and bends by kBend per square root of a unit of the logarithm (Wahba, J. R. Stat.
/// Soc. B 40, 1978, 364: a smoothing spline as the mean of an integrated random walk).
/// docs/equations.md, changes.
class AmplitudeCurve {
 public:
  static constexpr double kUsualPerLog = 0.035, kBend = 0.03;
  /// Highest over lowest amplitude from which on a curve is drawn; over less the baseline's value
  /// holds, because a slope would be mostly noise.
  static constexpr double kSpan = 3;

  AmplitudeCurve() = default;  ///< follows nothing
  /// value: the parameter's baseline > 0; own_error: of it, relative. At most AmplitudeBins::kBins
  /// points; without any it follows nothing.
  AmplitudeCurve(double value, double own_error, const std::vector<AmplitudePoint>& points);

  bool known() const { return !at_.empty(); }
  struct Expected {
    double ratio;      ///< to the baseline's value
    double std_error;  ///< of that, the error of the value itself among it
  };
  /// Precondition: known(); amplitude_m > 0.
  Expected expected(double amplitude_m) const;
  /// What the ratio may be, `errors` standard errors either way beyond as many of the value itself:
  /// below the amplitudes that were
  /// learned no lower than at the lowest of them, above no higher than at the highest.
  double least(double amplitude_m, double errors) const;
  double most(double amplitude_m, double errors) const;
  bool spans() const;
  /// Learned from.
  double lowest_m() const;
  double highest_m() const;
  /// Relative change per unit of the logarithm of the amplitude, at an amplitude.
  double slope(double amplitude_m) const;

 private:
  double covariance(double a, double b) const;
  Expected at_log(double log) const;

  double origin_ = 0;       ///< logarithm, where the slope is drawn to zero
  double own_error_ = 0;    ///< of the value itself, relative
  std::vector<double> at_;  ///< logarithms of the points
  std::vector<double> weights_, inverse_;
};

/// Sums of a parameter's windows by amplitude, in steps of kStep of the logarithm, kBins of them
/// about the first one; what lies beyond is counted with the outermost. Bounded.
class AmplitudeBins {
 public:
  static constexpr int kBins = 24;
  static constexpr double kStep = 0.35;

  /// amplitude_m > 0; off: the value over the first one, less 1; weight: 1 / error^2 of it.
  void push(double amplitude_m, double off, double weight);

  /// Of values that are `first` (1 + off).
  std::vector<AmplitudePoint> points(double first) const;
  /// How much wider the values scatter about the curve than their errors say, as a ratio of
  /// variances, >= 1; 1 while there are too few.
  double excess() const;
  bool any() const;

  template <typename Archive>
  void archive(Archive& a) {
    a.finite(first_log_);
    a(bins_);
  }

 private:
  /// About the curve: as a ratio of variances, and the variance, relative, beyond what errors and
  /// chance explain. That is no noise but what the element has gone through before, and lasts.
  struct Scatter {
    double excess = 1, lasting = 0;
  };
  Scatter scatter() const;
  struct Bin {
    int count = 0;
    double weight = 0, log = 0, off = 0;  ///< weighted sums
    double log_square = 0, off_square = 0, log_off = 0;

    template <typename Archive>
    void archive(Archive& a) {
      a.within(count, 0, a.kMaxCount);
      a.finite(weight, log, off, log_square, off_square, log_off);
    }
  };
  double first_log_ = 0;
  std::array<Bin, kBins> bins_{};
};

/// The amplitudes that an element has gone through of late: what it was shaken by is forgotten as
/// slowly as it recovers, in inverse proportion to the time since. Bounded.
class RecentAmplitude {
 public:
  /// An amplitude counts in full for so long, then kHolds_s over its age.
  static constexpr double kHolds_s = 20;
  static constexpr std::size_t kMax = 8;

  /// One that comes late, before the last one, is left out.
  void push(double time_s, double amplitude_m);
  /// The last one; 0: nothing.
  double newest() const { return count_ > 0 ? amplitude_[count_ - 1] : 0; }
  /// The largest of what is remembered; 0: nothing.
  double at(double time_s) const;

  template <typename Archive>
  void archive(Archive& a) {
    a.within(count_, 0, static_cast<double>(kMax));
    a.finite(time_s_, amplitude_);
  }

 private:
  double remembered(std::size_t i, double time_s) const;

  std::size_t count_ = 0;  ///< the newest last, each smaller than those before it
  std::array<double, kMax> time_s_{}, amplitude_{};
};

}  // namespace framewatch::estimator
