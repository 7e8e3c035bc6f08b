#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/tools/report/session_file.h"
#include "estimator/motion/noise_meter.h"
#include "estimator/motion/sample.h"
#include "estimator/motion/sample_merger.h"
#include "estimator/structure/sensors.h"

namespace framewatch::daemon {

/// A table of them for people, a line each.
std::string channels_text(const std::vector<ChannelResult>& results);

/// Computes statistics of all channels, before a test and of it, and finds their problems.
class ChannelCheck {
 public:
  ChannelCheck(const std::vector<estimator::SensorAxis>& axes, double rate_hz);

  void push(const estimator::SampleSet& set);
  /// Seconds of samples since it began.
  double seconds() const { return static_cast<double>(sets_) / rate_hz_; }
  /// Statistics since the last begin(); `counters`: their present values.
  std::vector<ChannelResult> results(const std::vector<estimator::AxisCounters>& counters) const;
  /// Begins anew; the measurement of noise goes on.
  void begin(const std::vector<estimator::AxisCounters>& counters);

 private:
  struct Sums {
    std::int64_t samples = 0, missing = 0;
    double first = 0, sum = 0, squares = 0;  ///< of differences from the first value
    double lowest = 0, highest = 0;
  };
  std::string problem(std::size_t axis, const ChannelResult& result) const;

  std::vector<estimator::SensorAxis> axes_;
  double rate_hz_;
  estimator::NoiseMeter noise_;
  std::int64_t sets_ = 0;
  std::vector<Sums> sums_;
  std::vector<estimator::AxisCounters> before_;
};

}  // namespace framewatch::daemon
