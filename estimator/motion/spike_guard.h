#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace framewatch::estimator {

/// Finds samples that no structure makes: of one axis alone, far outside what that axis has done in
/// the last two to four seconds, while no other axis stirs.
///
/// A sample is in doubt when it lies kFar mean steps (changes per sample) beyond the newest
/// extremes of its axis, by a step kAbrupt times the one before. It is sound after all when another
/// axis has made a step of kStirred of its own mean ones, as in an onset, a tap or an impact,
/// within kLookAhead instants; or when the axis rings: the samples that follow are smaller, or back
/// where the axis was before and out again, none of them by more than kMaxAlone. Otherwise it is
/// absurd, and so are those that follow until they are back, for kLongest_s at most: what stays is
/// another bias. Nothing is in doubt before an axis has been seen for a second. docs/equations.md,
/// absurd samples.
class SpikeGuard {
 public:
  static constexpr int kLookAhead = 4;
  static constexpr double kFar = 30, kAbrupt = 8, kStirred = 6, kBack = 6;
  static constexpr double kMinStep = 1e-6;  ///< m/s^2: a smaller mean step is taken for this
  static constexpr double kMaxAlone = 20;   ///< m/s^2: rings without another axis
  static constexpr int kStirring = 10;      ///< instants for which a large step counts
  static constexpr double kLongest_s = 1.2, kPeriod_s = 2;

  SpikeGuard(int axes, double rate_hz);

  /// Bits of ages, bit 0 the newest sample, that are decided now.
  struct Decided {
    unsigned sound = 0, absurd = 0;
  };

  /// The next instant's value of an axis, NaN for none; finest: its smallest step, 0 while it never
  /// changed. Then decide(), for every axis.
  void see(int axis, double value, double finest);
  Decided decide(int axis);
  /// The input has ended: what is still in doubt.
  Decided finish(int axis);

  template <typename Archive>
  void archive(Archive& a) {
    a(axis_);
  }

 private:
  struct Axis {
    double last = 0;                         ///< newest sound value
    double step = 0, step_before = 0;        ///< mean change of values; at the end of last period
    double change = 0;                       ///< the newest
    double low = 0, high = 0;                ///< in this period of kPeriod_s
    double low_before = 0, high_before = 0;  ///< in the one before
    double least_step = 0;                   ///< taken for its mean one when that is smaller
    int seen = 0;                            ///< sound changes, up to a second of them
    int in_period = 0;                       ///< changes of this period
    int still = 0;                           ///< instants since it made a large step
    int out = 0;                             ///< instants since it went far out; 0: it has not
    bool rejected = false;                   ///< some since then
    bool rings = false, violent = false;
    unsigned doubtful = 0;  ///< bits of ages
    unsigned back = 0;      ///< likewise: sound, but after a doubtful one
    std::array<double, kLookAhead + 1> held{};

    template <typename Archive>
    void archive(Archive& a) {
      a.finite(last, change, step, step_before, low, high, low_before, high_before);
      for (int* number : {&seen, &in_period, &still, &out}) a.within(*number, 0, 1e6);
      for (unsigned* ages : {&doubtful, &back}) a.within(*ages, 0, (2 << kLookAhead) - 1);
      a(rejected, rings, violent, held);
    }
  };
  Axis& of(int axis) { return axis_[static_cast<std::size_t>(axis)]; }
  bool beyond(const Axis& axis, double value, double steps) const;
  bool others_stir(int axis) const;
  void take(Axis& axis, double value) const;
  Decided decide_all(Axis& axis, bool sound);
  unsigned take_ages(Axis& axis, unsigned ages) const;

  int second_, period_, longest_;  ///< instants
  std::vector<Axis> axis_;
};

}  // namespace framewatch::estimator
