// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/tools/report/session_file.h"
#include "estimator/motion/noise_meter.h"
#include "estimator/motion/sample.h"
#include "estimator/motion/sample_merger.h"
#include "estimator/structure/sensors.h"

namespace framewatch::daemon {

/// Measures how far the acceleration of each axis is from its resting level. The level follows
/// offset and slow drift with a time constant of 5 s.
class RestLevel {
 public:
  RestLevel(std::size_t axes, double rate_hz);

  /// Returns the distances, m/s^2; NaN for a missing sample and during an axis' first second.
  const std::vector<double>& push(const estimator::SampleSet& set);

 private:
  struct Axis {
    double mean = 0;
    long seen = 0;
  };
  long settled_, memory_;  ///< samples
  std::vector<Axis> axes_;
  std::vector<double> distance_;
};

/// Finds which sensor was tapped, and whether it first moved in its positive direction. The user
/// taps every sensor's place in the building's positive direction, in any order.
///
/// A tap begins when an axis is further from rest than its threshold and than 2.5 times the
/// building's remaining ringing. The axis with the largest distance in the next quarter of a second
/// was tapped. Its sign is that of the first sample beyond half of that distance: the blow itself,
/// which is several times stronger than the structure's answer.
class TapTest {
 public:
  struct Tap {
    int axis;     ///< -1: unclear, because another axis moved nearly as much
    int sign;     ///< 1 positive, -1 negative
    double peak;  ///< m/s^2
  };

  TapTest(std::size_t axes, double rate_hz);

  /// Takes distances from rest of one instant and thresholds, m/s^2, by axis; NaN: no sample.
  /// Returns a tap when one has ended.
  std::optional<Tap> push(const std::vector<double>& distance,
                          const std::vector<double>& threshold);

 private:
  Tap judge() const;

  long pulse_, rest_;  ///< samples
  double forget_;      ///< decay of the ringing per sample
  long since_ = -1;    ///< samples since the tap began; -1: no tap
  std::vector<std::vector<double>> pulse_rows_;
  std::vector<double> ringing_;  ///< m/s^2
};

/// Returns a table of the results, one line per channel.
std::string channels_text(const std::vector<ChannelResult>& results);

/// Computes statistics of all channels, before and during a test, and finds their problems.
class ChannelCheck {
 public:
  ChannelCheck(const std::vector<estimator::SensorAxis>& axes, double rate_hz);

  void push(const estimator::SampleSet& set);
  /// Returns the seconds of samples since the last begin().
  double seconds() const { return static_cast<double>(sets_) / rate_hz_; }
  /// Returns the statistics since the last begin(). counters: their present values.
  std::vector<ChannelResult> results(const std::vector<estimator::AxisCounters>& counters) const;
  /// Restarts the statistics; the measurement of noise continues.
  void begin(const std::vector<estimator::AxisCounters>& counters);

 private:
  struct Sums {
    std::int64_t samples = 0, missing = 0;
    double first = 0, sum = 0, squares = 0;  ///< sums of differences from the first value
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
