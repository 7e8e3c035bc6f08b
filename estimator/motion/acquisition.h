// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "estimator/motion/axis_guard.h"
#include "estimator/motion/pulled.h"
#include "estimator/motion/sample.h"
#include "estimator/motion/sample_merger.h"
#include "estimator/setup/pipeline_config.h"
#include "estimator/structure/sensors.h"

namespace framewatch::estimator {

/// Repairs single lost samples by the cubic through their four neighbors, two instants later: x =
/// (4 (x-1 + x+1) - (x-2 + x+2)) / 6. Longer losses stay NaN. docs/equations.md, lost samples.
class LostSampleFiller {
 public:
  /// `repair` has one flag per axis: 0 leaves the axis as it is.
  explicit LostSampleFiller(std::vector<std::uint8_t> repair);

  /// Takes the next set. Returns the set two instants older, or nullptr at the beginning.
  const SampleSet* push(const SampleSet& set);
  /// Returns the sets still held, one per call, then nullptr. Call it when the input has ended.
  const SampleSet* drain();

  /// Returns the number of repaired samples per axis.
  const std::vector<std::int64_t>& repaired() const { return repaired_; }

  void archive(auto& a) {
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
  int waiting_ = 0;  ///< sets that have not been returned yet
  SampleSet out_;
  std::vector<std::int64_t> repaired_;
};

/// Converts scaled sensor values to absolute acceleration along the frames, m/s^2. Corrects offset,
/// polarity, gravity on a tilted axis, and the share of the other horizontal direction on an axis
/// that is turned in plan. docs/equations.md, mounting.
class Calibration {
 public:
  explicit Calibration(const std::vector<SensorAxis>& axes);
  /// Corrects one value per axis in place. An axis becomes NaN if the axis that corrects it has no
  /// value.
  void apply(std::vector<double>& accel);

 private:
  struct Axis {
    double gain, offset;  ///< value = gain * (scaled - offset)
    int cross;            ///< -1: no correction by another axis
    double own = 1, other = 0;
  };
  std::vector<Axis> axes_;
  std::vector<double> straight_;
};

/// Largest plausible acceleration of a building, a table or an impact, m/s^2 in either direction:
/// 20 g.
inline constexpr double kMaxAccel = 200;
/// Smallest plausible reading other than 0, m/s^2. No sensor resolves it, so a smaller number is
/// other data read as an acceleration.
inline constexpr double kMinAccel = 1e-30;

/// The range of readings that a channel can have, m/s^2 of scale times raw. A sample outside never
/// enters a filter.
struct SampleBound {
  double least, most;

  /// Returns false for a value outside the range and for NaN.
  bool holds(double scaled) const {
    return scaled >= least && scaled <= most && (std::abs(scaled) >= kMinAccel || scaled == 0);
  }
};

/// Returns the bound of an axis. With a configured range, it is kBeyondRange times that range on
/// either side of 0; values beyond the range itself count as clipped (AxisGuard). Without a range,
/// it is kMaxAccel on either side of the offset.
inline SampleBound sample_bound(const SensorAxis& axis) {
  constexpr double kBeyondRange = 1.25, kMaxForce_n = 1e12;
  if (axis.range > 0) return {-kBeyondRange * axis.range, kBeyondRange * axis.range};
  if (axis.is_force) return {-kMaxForce_n, kMaxForce_n};
  return {axis.offset - kMaxAccel, axis.offset + kMaxAccel};
}

/// Returns the part of a delay that is whole samples, s.
double whole_delay_s(double delay_s, double rate_hz);

/// Turns raw samples into clean sample sets. It rejects impossible values (SampleBound), subtracts
/// whole-sample delays from the stamps, merges the axes on one grid, removes values of failing
/// sensors, calibrates, and fills single losses. The remaining fraction of a delay is left to the
/// user of the sets (SensorAxis::delay of axes()).
class Acquisition {
 public:
  using SampleSets = Pulled<Acquisition, SampleSet>;

  /// lone_spikes: keeps spikes that one axis shows alone (AxisGuard).
  explicit Acquisition(const std::vector<SensorAxis>& axes, const EstimatorOptions& options,
                       bool lone_spikes = false);

  /// Takes a sample. Returns the calibrated instants that it completes, oldest first.
  SampleSets push(const AccelSample& raw) {
    take(raw);
    return SampleSets(*this);
  }
  /// Ends the input. Returns the instants that were still open.
  SampleSets finish() {
    end();
    return SampleSets(*this);
  }

  /// The parts of push() and finish(): after take() or end(), call next() until it returns null.
  /// Each instant is valid until the next call.
  void take(const AccelSample& raw);
  void end();
  const SampleSet* next();

  /// Returns the configured axes with the remaining fractions of their delays.
  const std::vector<SensorAxis>& axes() const { return axes_; }
  std::vector<AxisCounters> counters() const;

  void archive(auto& a) { a(merger_, guard_, filler_); }

 private:
  enum class Ending { no, guard, filler };
  const SampleSet* repaired(const SampleSet& guarded);

  std::vector<SensorAxis> axes_;
  std::vector<SensorClock::duration> whole_delay_;
  std::vector<SampleBound> bound_;
  SampleMerger merger_;
  AxisGuard guard_;
  Calibration calibration_;
  LostSampleFiller filler_;
  SampleSet calibrated_;
  std::optional<AccelSample> waiting_;  ///< for the merger, which is full
  Ending ending_ = Ending::no;          ///< which of the delays next() empties
};

}  // namespace framewatch::estimator
