#pragma once

#include <Eigen/Core>

#include "daemon/config_section.h"
#include "estimator/structure/structure.h"

namespace framewatch::daemon {

/// What the virtual building really is, table order, SI: [truth] over the design (which may be
/// empty). Damping is proportional to the stiffness where it is not given.
Eigen::VectorXd read_truth(ConfigSection& section, const Structure& structure,
                           const Eigen::VectorXd& design);

}  // namespace framewatch::daemon
