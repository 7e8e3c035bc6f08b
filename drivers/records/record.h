#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/records/axis_header.h"

namespace framewatch::drivers {

/// Measured or simulated motion over some time, on one clock: every sensor axis at every instant.
struct Record {
  std::vector<std::string> names;               ///< of the axes; record files call them channels
  std::vector<double> time_s;                   ///< strictly increasing
  std::vector<std::vector<double>> accel_mps2;  ///< [axis][instant]; NaN where missing
  double rate_hz = 0;                           ///< nominal: 1 / the even step
  std::vector<std::string> notes;   ///< what the reader assumed or left out, for a person
  std::vector<std::int64_t> lines;  ///< of the file, by instant; 0: filled in. Empty: no such file
  std::vector<AxisHeader> headers;  ///< of the axes, as the file says; empty: it says nothing
};

}  // namespace framewatch::drivers
