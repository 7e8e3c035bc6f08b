#pragma once

#include <cstdint>
#include <string>

namespace framewatch::daemon {

/// Statistics of one channel over some time. Calibrated, m/s^2.
struct ChannelResult {
  std::string name;
  double noise_density = 0;  ///< m/s^2/sqrt(Hz), above a quarter of the sampling rate; NaN: unknown
  double rms = 0;            ///< without the mean
  double offset = 0;         ///< mean
  double peak = 0;           ///< largest distance from zero
  double range = 0;          ///< of the sensor; 0: unknown
  std::int64_t samples = 0, missing = 0, saturated = 0, stuck = 0;
  int polarity = 0;     ///< of the tap test: 1 right, -1 reversed, 0 not tapped
  std::string problem;  ///< one sentence; empty: none
};

}  // namespace framewatch::daemon
