#pragma once

#include <cstdint>
#include <string>

#include "daemon/config/keys/section.h"
#include "estimator/simulate/ground_motion.h"

namespace framewatch::daemon {

/// [motion]: a record file (path relative to `directory`) or a seeded Kanai-Tajimi motion. Empty
/// after a problem.
estimator::PlanMotion read_motion(ConfigSection& section, const std::string& directory,
                                  std::uint64_t seed);

}  // namespace framewatch::daemon
