// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "daemon/config/keys/section.h"
#include "estimator/simulate/ground_motion.h"

namespace framewatch::daemon {

/// Format of a record file. For empty or 0, the file must state it.
struct MotionFileFormat {
  std::string unit;    ///< g, gal or mps2
  double step_s = 0;   ///< sampling step of a file without times
  std::string column;  ///< channel to read from a file with several
};

/// Reads one channel of a record file, evenly sampled. Sets `problem`, with its place, on failure.
estimator::GroundMotion read_recorded_motion(const std::string& path,
                                             const MotionFileFormat& format, std::string& problem);

/// Reads [motion]: a record file (path relative to `directory`) or a seeded Kanai-Tajimi motion.
/// Returns an empty motion after a problem.
estimator::PlanMotion read_motion(ConfigSection& section, const std::string& directory,
                                  std::uint64_t seed);

}  // namespace framewatch::daemon
