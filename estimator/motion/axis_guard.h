#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "estimator/motion/sample.h"
#include "estimator/motion/spike_guard.h"

namespace framewatch::estimator {

/// Removes the samples of a failing sensor: those that no structure makes (absurd, SpikeGuard),
/// those at the end of its range (clipped), and a value that does not change while the building
/// moves (stuck). Works on scaled, otherwise uncorrected values, m/s^2.
///
/// Stuck: five equal samples of an axis that was moving by 50 of its smallest steps per sample, or
/// half a second of equal samples while the other axes of its direction move by ten such steps. An
/// axis that is quiet because the building is, is not stuck. Clipped: at the configured range, or
/// three equal samples at the largest or smallest value so far of a moving axis; that value then
/// counts as the end of the range until a sample goes beyond it. The neighbours of a clipped peak
/// are removed too, so that it is not interpolated across.
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

  static constexpr int kLookAhead = SpikeGuard::kLookAhead;

  template <typename Archive>
  void archive(Archive& a) {
    a(state_, spikes_, ring_);
    a.within(newest_, 0, kSlots - 1);
    a.within(waiting_, 0, kSlots);
    a(stuck_, clipped_, absurd_);
  }

 private:
  struct State {
    Axis axis;
    double last = 0;
    bool seen = false;
    int run = 0;                     ///< equal samples so far
    double step = 0;                 ///< mean change per sample while it moved
    double smallest_step = 0;        ///< smallest change ever seen; 0 = it never changed
    int finer = 0;                   ///< changes lately that are far smaller than that
    double lowest = 0, highest = 0;  ///< values so far
    /// Values at which it was seen to clip; infinite: never.
    double clips_at = std::numeric_limits<double>::infinity();
    double clips_below = -std::numeric_limits<double>::infinity();
    bool still = false;       ///< judged stuck, until it moves
    bool after_clip = false;  ///< the sample after a clipped one goes too

    template <typename Archive>
    void archive(Archive& a) {
      a.finite(last, step, smallest_step, lowest, highest);
      a.within(run, 0, a.kMostCount);
      a.within(finer, 0, a.kMostCount);
      a(seen, clips_at, clips_below, still, after_clip);
    }
  };
  SampleSet& held(int age) {
    return ring_[static_cast<std::size_t>((newest_ + kSlots - age) % kSlots)];
  }
  void decide(std::size_t a);
  void take_out_absurd(std::size_t a, unsigned ages);
  void judge(std::size_t a, double value, int age);
  void watch_step(State& s, double value) const;
  void remove(std::size_t a, int age, std::vector<std::int64_t>& counter);
  double others_moving(std::size_t a);
  const SampleSet* give();

  static constexpr int kSlots = kLookAhead + 1;
  double forget_;  ///< of the mean step, per sample
  int long_run_;
  bool lone_spikes_;
  std::vector<State> state_;
  SpikeGuard spikes_;
  std::vector<SampleSet> ring_;
  std::vector<double> sorted_;
  int newest_ = 0, waiting_ = 0;
  SampleSet out_;
  std::vector<std::int64_t> stuck_, clipped_, absurd_;
};

}  // namespace framewatch::estimator
