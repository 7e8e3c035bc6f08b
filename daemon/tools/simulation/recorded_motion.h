#pragma once

#include <string>

#include "estimator/simulate/ground_motion.h"

namespace framewatch::daemon {

/// What a record file does not say itself. Empty or 0: the file must say it.
struct MotionFileFormat {
  std::string unit;    ///< g, gal or mps2
  double step_s = 0;   ///< of a file without times
  std::string column;  ///< channel of a file with several
};

/// One channel of a record file, evenly sampled. `problem` says what is wrong with it, with its
/// place.
estimator::GroundMotion read_recorded_motion(const std::string& path,
                                             const MotionFileFormat& format, std::string& problem);

}  // namespace framewatch::daemon
