#pragma once

#include <Eigen/Core>

#include "daemon/config/keys/section.h"
#include "estimator/structure/structure.h"

namespace framewatch::daemon {

/// True parameters of the virtual building, in table order, SI: [truth], else the design (which may
/// be empty). Damping is proportional to the stiffness where it is not given.
Eigen::VectorXd read_truth(ConfigSection& section, const estimator::Structure& structure,
                           const Eigen::VectorXd& design);

}  // namespace framewatch::daemon
