// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "estimator/motion/sample.h"

namespace framewatch::estimator {

/// Finds samples that no structure produces: those of a single axis, far outside its motion of the
/// last two to four seconds, while no other axis moves. docs/equations.md, absurd samples.
///
/// A sample is doubtful when it lies kFar mean steps (changes per sample) beyond the newest
/// extremes of its axis, by a step that is kAbrupt times the one before. It is sound in two cases.
/// First, within kLookAhead instants another axis makes a step of kStirred times its own mean step,
/// as in an onset, a tap or an impact. An axis of the same group is not a witness unless all axes
/// are in one group, because axes of one message, node or cable fail together. Second, the axis
/// rings: the following samples are smaller, or return and move out again, none of them by more
/// than kMaxAlone.
///
/// Otherwise the sample is absurd, and so are the following ones until the axis returns, for at
/// most kLongest_s; what lasts longer is a new bias. No sample is doubtful before the axis has
/// delivered for a second.
class SpikeGuard {
 public:
  static constexpr int kLookAhead = 4;
  static constexpr double kFar = 30, kAbrupt = 8, kStirred = 6, kBack = 6;
  static constexpr double kMinStep = 1e-6;  ///< m/s^2: least mean step that is assumed
  static constexpr double kMaxAlone = 20;   ///< m/s^2: largest ringing without another axis
  static constexpr int kStirring = 10;      ///< instants for which a large step counts
  static constexpr double kLongest_s = 1.2, kPeriod_s = 2;

  /// groups: a number for each axis. Axes with the same number fail together.
  SpikeGuard(const std::vector<int>& groups, double rate_hz);

  /// The samples that are decided now, as bits of ages; bit 0 is the newest sample.
  struct Decided {
    unsigned sound = 0, absurd = 0;
  };

  /// Takes the next value of an axis; NaN if it has no value. finest: the axis's smallest step, 0
  /// if it never changed. Call decide() for every axis when all values of the instant have been
  /// pushed.
  void push(int axis, double value, double finest);
  Decided decide(int axis);
  /// Decides what is still doubtful. Call it when the input has ended.
  Decided finish(int axis);

  void archive(auto& a) { a(axis_); }

 private:
  struct Axis {
    int group = 0;
    double last = 0;                         ///< newest sound value
    double step = 0, step_before = 0;        ///< mean change now, and at the end of the last period
    double change = 0;                       ///< newest change
    double low = 0, high = 0;                ///< extremes of this period of kPeriod_s
    double low_before = 0, high_before = 0;  ///< extremes of the period before
    double least_step = 0;                   ///< least mean step that is assumed
    int seen = 0;                            ///< sound changes, counted up to one second
    int in_period = 0;                       ///< changes in this period
    int still = 0;                           ///< instants since the last large step
    int out = 0;                             ///< instants since it went far out; 0: it is not out
    bool rejected = false;                   ///< some samples have been rejected since then
    bool rings = false, violent = false;
    unsigned doubtful = 0;  ///< ages as bits
    unsigned back = 0;      ///< ages as bits: sound, but after a doubtful sample
    std::array<double, kLookAhead + 1> held{};

    void archive(auto& a) {
      a.finite(last, change, step, step_before, low, high, low_before, high_before);
      for (int* number : {&seen, &in_period, &still, &out}) a.within(*number, 0, 1e6);
      for (unsigned* ages : {&doubtful, &back}) a.within(*ages, 0, (2 << kLookAhead) - 1);
      a(rejected, rings, violent, held);
    }
  };
  Axis& of(int axis) { return axis_[static_cast<std::size_t>(axis)]; }
  const Axis& of(int axis) const { return axis_[static_cast<std::size_t>(axis)]; }
  bool beyond(const Axis& axis, double value, double steps) const;
  bool others_stir(int axis) const;
  void take(Axis& axis, double value) const;
  Decided decide_all(Axis& axis, bool sound);
  unsigned take_ages(Axis& axis, unsigned ages) const;

  int second_, period_, longest_;  ///< instants
  std::vector<Axis> axis_;
};

/// Removes the samples of a failing sensor: absurd ones (SpikeGuard), those at the end of the
/// sensor's range (clipped), and a value that does not change although the other axes predict that
/// it should (stuck). Works on scaled, otherwise uncorrected values, m/s^2.
///
/// The neighbors of an axis are the other axes of its direction, or all others if it is the only
/// one. They predict its motion: their motion now, times the ratio of its mean step to theirs while
/// it last moved (1 before it ever moved). Its resolution is its smallest step, at least kFinest.
///
/// An axis is stuck in two cases. First, it moved by 50 times its resolution per sample, has had
/// five or more equal samples since, and its neighbors predict 200 times its resolution meanwhile.
/// Second, it has not changed for half a second and they predict ten times its resolution per
/// sample. So an axis is not stuck if the building is quiet, if its resolution is coarser than the
/// motion, or if a record begins or ends with zeros on every channel.
///
/// When an axis and all its neighbors stop at the same sample, no sensor is stuck. If the motion is
/// above a third of the strongest of the last minutes, no structure stops like this: the recorder
/// delivered no samples. The first half second is then removed as missing; later values count as
/// rest. From weaker motion they count at once, as in a record that was cut off in its tail.
///
/// An axis is clipped at the configured range, or when a moving axis has three equal samples at the
/// largest or smallest value so far. That value then counts as the end of the range until a sample
/// exceeds it. The samples beside a clipped peak are removed too, so that interpolation does not
/// cross it.
class AxisGuard {
 public:
  struct Axis {
    double range = 0;    ///< m/s^2 of the scaled value; 0: unknown
    int direction = 0;   ///< axes of one direction are compared
    int group = 0;       ///< axes with the same number fail together
    bool judged = true;  ///< false for a force, which rests at 0 and jumps when a hammer strikes
  };
  /// lone_spikes: keep what a single axis shows, because someone taps at the sensors.
  AxisGuard(const std::vector<Axis>& axes, double rate_hz, bool lone_spikes = false);

  /// Takes the next set. Returns the set kLookAhead instants older, or nullptr at the beginning.
  const SampleSet* push(const SampleSet& set);
  /// Returns the sets still held, one per call, then nullptr. Call it when the input has ended.
  const SampleSet* drain();

  /// Return the number of samples removed for each reason, per axis.
  const std::vector<std::int64_t>& stuck() const { return stuck_; }
  const std::vector<std::int64_t>& clipped() const { return clipped_; }
  const std::vector<std::int64_t>& absurd() const { return absurd_; }
  const std::vector<std::int64_t>& missing() const { return missing_; }

  static constexpr int kLookAhead = SpikeGuard::kLookAhead;
  static constexpr double kFinest = 1e-6;  ///< m/s^2: finest resolution of an accelerometer

  void archive(auto& a) {
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
    int run = 0;                 ///< equal samples in a row
    double step = 0;             ///< mean change per sample, over samples that changed
    double motion = 0;           ///< mean change per sample, over all samples
    double strongest = 0;        ///< largest `motion`, decaying over minutes
    double own = 0, others = 0;  ///< mean motion of the axis and of its neighbors while it moved
    double predicted = 0;        ///< predicted change since the run began
    double smallest_step = 0;    ///< smallest change so far; 0: it never changed
    int finer = 0;               ///< recent changes that are far smaller than smallest_step
    double lowest = 0, highest = 0;  ///< extremes so far
    /// Values at which the axis was seen to clip; infinite: not seen.
    double clips_at = std::numeric_limits<double>::infinity();
    double clips_below = -std::numeric_limits<double>::infinity();
    bool still = false;       ///< stuck until it moves
    bool paused = false;      ///< everything stopped at once, at most half a second ago
    bool after_clip = false;  ///< also remove the next sample

    void archive(auto& a) {
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
  double forget_;          ///< forgetting of the mean step, per sample
  double keep_strongest_;  ///< decay of the strongest motion, per sample
  double forget_ratio_;    ///< forgetting of the compared motions, per kSlots samples
  int long_run_;
  bool lone_spikes_;
  std::vector<State> state_;
  SpikeGuard spikes_;
  std::vector<SampleSet> ring_;
  std::vector<std::uint8_t> alone_;  ///< the axis is the only one of its direction
  /// The newest change of every axis, and its way over the last kLookAhead changes. Not part of the
  /// state.
  std::vector<double> change_, way_;
  /// State::motion, or 0 for an axis that does not move; not part of the state.
  std::vector<double> moving_;
  std::vector<double> sorted_;
  int newest_ = 0, waiting_ = 0;
  SampleSet out_;
  std::vector<std::int64_t> stuck_, clipped_, absurd_, missing_;
};

}  // namespace framewatch::estimator
