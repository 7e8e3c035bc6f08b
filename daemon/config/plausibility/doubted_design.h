#pragma once

#include <vector>

#include <Eigen/Core>

#include "daemon/base/toml_document.h"
#include "estimator/structure/structure.h"

namespace framewatch::daemon {

/// The part of doubted_values() about [structure.design], whose table `section` is.
void doubt_design(const TomlValue& section, const estimator::Structure& structure,
                  const Eigen::VectorXd& design, std::vector<TextProblem>& doubts);

}  // namespace framewatch::daemon
