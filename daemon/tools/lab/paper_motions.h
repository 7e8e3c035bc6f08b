#pragma once

#include <optional>
#include <string>

#include "estimator/simulate/ground_motion.h"

namespace framewatch::daemon {

/// The paper's ground motions, which are not part of the program: El Centro 1940 NS and Hachinohe
/// 1968 NS in the folder `ground_motions` of `data`. Empty when the file is not there or not what
/// it should be.
std::optional<estimator::GroundMotion> el_centro_ns(const std::string& data);
std::optional<estimator::GroundMotion> hachinohe_ns(const std::string& data);

}  // namespace framewatch::daemon
