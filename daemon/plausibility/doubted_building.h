#pragma once

#include <vector>

#include <Eigen/Core>

#include "daemon/documents/toml_document.h"
#include "estimator/structure/structure.h"

namespace framewatch::daemon {

/// What a valid [structure] says and hardly any building has, each at its value in the document,
/// with what such buildings have and the likely slip: story heights, spans, mass per floor area,
/// first natural frequency, its damping ratio, stories of very unequal stiffness. With a mean story
/// height of 2 m and more it is judged as a building, below as a model on a table. `design`: theta
/// in SI units, or empty.
std::vector<TextProblem> doubted_values(const TomlValue& document,
                                        const estimator::Structure& structure,
                                        const Eigen::VectorXd& design);

}  // namespace framewatch::daemon
