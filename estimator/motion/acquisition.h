#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "estimator/motion/calibration.h"
#include "estimator/motion/channel_guard.h"
#include "estimator/motion/gap_filler.h"
#include "estimator/motion/sample_merger.h"
#include "estimator/options.h"

namespace framewatch {

/// Raw samples in, clean sample sets out: whole-sample delays taken off the stamps, axes merged on
/// one grid, failing sensors' values taken out, calibrated, single losses filled. What is left of a
/// delay, less than a sample, is the reader's (SensorAxis::delay of axes()).
class Acquisition {
 public:
  using Sink = std::function<void(const SampleSet&)>;

  Acquisition(const std::vector<SensorAxis>& axes, const EstimatorOptions& options, Sink sink);

  void push(const AccelSample& raw);
  /// The input has ended: gives out everything still held.
  void finish();

  /// The configured axes with what is left of their delays.
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
  SampleMerger merger_;
  ChannelGuard guard_;
  Calibration calibration_;
  GapFiller filler_;
  SampleSet calibrated_;
  Sink sink_;
};

}  // namespace framewatch
