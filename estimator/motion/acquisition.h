#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "estimator/motion/axis_guard.h"
#include "estimator/motion/calibration.h"
#include "estimator/motion/lost_sample_filler.h"
#include "estimator/motion/pulled.h"
#include "estimator/motion/sample_bound.h"
#include "estimator/motion/sample_merger.h"
#include "estimator/setup/options.h"

namespace framewatch::estimator {

/// The part of a delay that is whole samples, s.
double whole_delay_s(double delay_s, double rate_hz);

/// Turns raw samples into clean sample sets: rejects values that no sensor can measure
/// (SampleBound), subtracts whole-sample delays from the stamps, merges the axes on one grid,
/// removes values of failing sensors, calibrates, and fills single losses. The fraction of a delay
/// that is less than a sample remains (SensorAxis::delay of axes()).
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

  /// The configured axes with the remaining fractions of their delays.
  const std::vector<SensorAxis>& axes() const { return axes_; }
  std::vector<AxisCounters> counters() const;

  template <typename Archive>
  void archive(Archive& a) {
    a(merger_, guard_, filler_);
  }

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
