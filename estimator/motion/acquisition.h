#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "estimator/motion/axis_guard.h"
#include "estimator/motion/sample.h"
#include "estimator/motion/sample_merger.h"
#include "estimator/setup/pipeline_config.h"
#include "estimator/structure/sensors.h"

namespace framewatch::estimator {

/// Repairs single lost samples by the cubic through their four neighbours, two instants later:
/// x = (4 (x-1 + x+1) - (x-2 + x+2)) / 6. Longer losses stay NaN. docs/equations.md, lost samples.
class LostSampleFiller {
 public:
  /// repair: flags of the axes.
  explicit LostSampleFiller(std::vector<std::uint8_t> repair);

  /// Takes the next set; returns the set two instants older, or null while there is none.
  const SampleSet* push(const SampleSet& set);
  /// The input has ended: gives out the sets still held, one per call.
  const SampleSet* drain();

  /// Samples repaired so far, per axis.
  const std::vector<std::int64_t>& repaired() const { return repaired_; }

  template <typename Archive>
  void archive(Archive& a) {
    a(ring_);
    a.within(next_, 0, 4);
    a.within(filled_, 0, 5);
    a.within(waiting_, 0, kLookAhead + 1);
    a(repaired_);
  }

 private:
  static constexpr int kLookAhead = 2;
  SampleSet& held(int age) { return ring_[static_cast<std::size_t>((next_ + 4 - age) % 5)]; }
  void repair();
  const SampleSet* give();

  std::vector<std::uint8_t> repair_;
  std::array<SampleSet, 5> ring_;
  int next_ = 0;     ///< slot of the next set
  int filled_ = 0;   ///< consecutive sets held, at most 5
  int waiting_ = 0;  ///< sets not yet given out
  SampleSet out_;
  std::vector<std::int64_t> repaired_;
};

/// From scaled sensor values to absolute acceleration along the frames, m/s^2: offset, polarity,
/// gravity on a tilted axis, and the share of the other horizontal direction on an axis that is
/// turned in plan. docs/equations.md, mounting.
class Calibration {
 public:
  explicit Calibration(const std::vector<SensorAxis>& axes);
  /// In place, one value per axis; an axis without the value it is corrected with becomes NaN.
  void apply(std::vector<double>& accel);

 private:
  struct Axis {
    double gain, offset;  ///< value = gain * (scaled - offset)
    int cross;            ///< -1 none
    double own = 1, other = 0;
  };
  std::vector<Axis> axes_;
  std::vector<double> straight_;
};

/// No building, table or impact on them has accelerations beyond this, m/s^2 either way: 20 g.
inline constexpr double kMaxAccel = 200;
/// No sensor resolves this, m/s^2: a smaller number than it that is not 0 is no reading, but
/// another kind of number taken for one.
inline constexpr double kMinAccel = 1e-30;

/// The readings that a channel can have, m/s^2 of scale times raw. A sample outside is no
/// measurement, whatever it is: it never enters a filter.
struct SampleBound {
  double least, most;

  /// False for what is no number.
  bool holds(double scaled) const {
    return scaled >= least && scaled <= most && (std::abs(scaled) >= kMinAccel || scaled == 0);
  }
};

/// With a range, kBeyondRange of it on either side of 0: what is between the two is clipped
/// (AxisGuard). Without one, kMaxAccel on either side of the offset.
inline SampleBound sample_bound(const SensorAxis& axis) {
  constexpr double kBeyondRange = 1.25, kMaxForce_n = 1e12;
  if (axis.range > 0) return {-kBeyondRange * axis.range, kBeyondRange * axis.range};
  if (axis.is_force) return {-kMaxForce_n, kMaxForce_n};
  return {axis.offset - kMaxAccel, axis.offset + kMaxAccel};
}

/// The part of a delay that is whole samples, s.
double whole_delay_s(double delay_s, double rate_hz);

/// Raw samples in, clean sample sets out: what no sensor can have measured rejected (SampleBound),
/// whole-sample delays taken off the stamps, axes merged on one grid, failing sensors' values
/// removed, calibrated, single losses filled. The fraction of a
/// delay that is less than a sample remains for the reader (SensorAxis::delay of axes()).
class Acquisition {
 public:
  using Sink = std::function<void(const SampleSet&)>;

  /// lone_spikes: whether what one axis alone does is kept (AxisGuard).
  Acquisition(const std::vector<SensorAxis>& axes, const EstimatorOptions& options, Sink sink,
              bool lone_spikes = false);

  void push(const AccelSample& raw);
  /// The input has ended: passes on everything still held.
  void finish();

  /// The configured axes with the remaining fractions of their delays.
  const std::vector<SensorAxis>& axes() const { return axes_; }
  std::vector<AxisCounters> counters() const;

  template <typename Archive>
  void archive(Archive& a) {
    a(merger_, guard_, filler_);
  }

 private:
  void drain();
  void guarded(const SampleSet& set);

  std::vector<SensorAxis> axes_;
  std::vector<SensorClock::duration> whole_delay_;
  std::vector<SampleBound> bound_;
  SampleMerger merger_;
  AxisGuard guard_;
  Calibration calibration_;
  LostSampleFiller filler_;
  SampleSet calibrated_;
  Sink sink_;
};

}  // namespace framewatch::estimator
