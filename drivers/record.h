#pragma once

#include <string>
#include <vector>

namespace framewatch::drivers {

/// A stretch of measured or simulated motion with one clock: every channel at every instant.
struct Record {
  std::vector<std::string> names;               ///< channel names
  std::vector<double> time_s;                   ///< strictly increasing
  std::vector<std::vector<double>> accel_mps2;  ///< [channel][instant]; NaN where missing
  double rate_hz = 0;                           ///< nominal: 1 / the even step
  std::vector<std::string> notes;               ///< things the reader had to decide, for the person
};

/// What went wrong with a file: place ("rec.csv:12" or "rec.csv") and rule.
struct Problem {
  std::string where;
  std::string message;
};

}  // namespace framewatch::drivers
