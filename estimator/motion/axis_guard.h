#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "estimator/motion/sample.h"

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

/// Removes the samples of a failing sensor: those that no structure makes (absurd, SpikeGuard),
/// those at the end of its range (clipped), and a value that does not change although the motion of
/// the other axes says that it should (stuck). Works on scaled, otherwise uncorrected values,
/// m/s^2.
///
/// An axis' neighbours are the other axes of its direction, or all others if it is alone there.
/// They predict how far it moves: their motion now, times its own mean step over theirs while it
/// last moved (1 before it ever moved). Its resolution is its smallest step, kFinest at least. It
/// is stuck when it was moving by 50 times its resolution per sample, has had five or more equal
/// samples since, and its neighbours meanwhile predict 200 times its resolution; or when it has
/// stood still for half a second and they predict ten times its resolution per sample. So an axis
/// that is quiet because the building is, is not stuck, nor is one whose resolution is coarser than
/// the motion, nor one of a record that begins or ends with zeros on every channel.
///
/// When an axis and all its neighbours stop at the same sample, no sensor is stuck. From a third of
/// the strongest motion of the last minutes no structure stops like this either: the recorder gave
/// no samples. The first half second of that is taken out as missing; after it the values count as
/// rest. From weaker motion they count at once: a record that was cut off in its tail.
///
/// Clipped: at the configured range, or three equal samples at the largest or smallest value so far
/// of a moving axis; that value then counts as the end of the range until a sample goes beyond it.
/// The neighbours of a clipped peak are removed too, so that it is not interpolated across.
class AxisGuard {
 public:
  struct Axis {
    double range = 0;    ///< m/s^2, of the scaled value; 0 = not known
    int direction = 0;   ///< axes of one direction are compared
    bool judged = true;  ///< false for a force: it rests at 0 and leaps when a hammer strikes
  };
  /// lone_spikes: whether what one axis alone does is kept: somebody taps at the sensors.
  AxisGuard(const std::vector<Axis>& axes, double rate_hz, bool lone_spikes = false);

  /// Takes the next set; returns the set kLookAhead instants older, or null while there is none.
  const SampleSet* push(const SampleSet& set);
  /// The input has ended: gives out the sets still held, one per call.
  const SampleSet* drain();

  /// Samples taken out so far, per axis.
  const std::vector<std::int64_t>& stuck() const { return stuck_; }
  const std::vector<std::int64_t>& clipped() const { return clipped_; }
  const std::vector<std::int64_t>& absurd() const { return absurd_; }
  const std::vector<std::int64_t>& missing() const { return missing_; }

  static constexpr int kLookAhead = SpikeGuard::kLookAhead;
  static constexpr double kFinest = 1e-6;  ///< m/s^2: no accelerometer resolves less

  template <typename Archive>
  void archive(Archive& a) {
    a(state_, spikes_, ring_);
    a.within(newest_, 0, kSlots - 1);
    a.within(waiting_, 0, kSlots);
    a(stuck_, clipped_, absurd_, missing_);
  }

 private:
  struct State {
    Axis axis;
    double last = 0;
    bool seen = false;
    int run = 0;                     ///< equal samples so far
    double step = 0;                 ///< mean change per sample, of those that changed
    double motion = 0;               ///< mean change per sample, of all
    double strongest = 0;            ///< of these, forgotten in minutes
    double own = 0, others = 0;      ///< mean motion while it moved, and its neighbours' then
    double predicted = 0;            ///< change since the run began
    double smallest_step = 0;        ///< smallest change ever seen; 0 = it never changed
    int finer = 0;                   ///< changes lately that are far smaller than that
    double lowest = 0, highest = 0;  ///< values so far
    /// Values at which it was seen to clip; infinite: never.
    double clips_at = std::numeric_limits<double>::infinity();
    double clips_below = -std::numeric_limits<double>::infinity();
    bool still = false;       ///< judged stuck, until it moves
    bool paused = false;      ///< everything stopped at once, half a second ago at most
    bool after_clip = false;  ///< the sample after a clipped one goes too

    template <typename Archive>
    void archive(Archive& a) {
      a.finite(last, step, smallest_step, lowest, highest);
      for (double* mean : {&motion, &strongest, &own, &others, &predicted})
        a.within(*mean, 0, a.kMax);
      a.within(run, 0, a.kMaxCount);
      a.within(finer, 0, a.kMaxCount);
      a(seen, clips_at, clips_below, still, paused, after_clip);
    }
  };
  SampleSet& held(int age) {
    return ring_[static_cast<std::size_t>((newest_ + kSlots - age) % kSlots)];
  }
  void decide(std::size_t a);
  void take_out_absurd(std::size_t a, unsigned ages);
  void judge(std::size_t a, double value, int age);
  void judge_still(std::size_t a, int age);
  void watch_step(State& s, double value) const;
  void watch_changes();
  void learn_ratios();
  void remove(std::size_t a, int age, std::vector<std::int64_t>& counter);
  bool neighbours(std::size_t a, std::size_t b) const;
  double others(std::size_t a, const std::vector<double>& of);
  bool others_predict(std::size_t a, double ratio, double resolution);
  bool all_stopped(std::size_t a) const;
  const SampleSet* give();

  static constexpr int kSlots = kLookAhead + 1;
  double forget_;          ///< of the mean step, per sample
  double keep_strongest_;  ///< of the strongest motion, per sample
  double forget_ratio_;    ///< of the motions that are compared, per kSlots samples
  int long_run_;
  bool lone_spikes_;
  std::vector<State> state_;
  SpikeGuard spikes_;
  std::vector<SampleSet> ring_;
  std::vector<std::uint8_t> alone_;  ///< in its direction
  /// Of every axis: the newest change, and the way of the last kLookAhead changes; not kept.
  std::vector<double> change_, way_;
  std::vector<double> moving_;  ///< State::motion, 0 of an axis that stands; not kept
  std::vector<double> sorted_;
  int newest_ = 0, waiting_ = 0;
  SampleSet out_;
  std::vector<std::int64_t> stuck_, clipped_, absurd_, missing_;
};

}  // namespace framewatch::estimator
