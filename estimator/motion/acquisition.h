#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "estimator/motion/axis_guard.h"
#include "estimator/motion/calibration.h"
#include "estimator/motion/lost_sample_filler.h"
#include "estimator/motion/sample_bound.h"
#include "estimator/motion/sample_merger.h"
#include "estimator/setup/options.h"

namespace framewatch::estimator {

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
