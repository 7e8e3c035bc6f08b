#pragma once

#include <vector>

#include <Eigen/Core>

#include "daemon/base/toml_document.h"
#include "estimator/structure/structure.h"

namespace framewatch::daemon {

/// What a valid [structure] says and hardly any building has, each at its value in the document,
/// with what such buildings have and the likely slip: story heights, spans, mass per floor area,
/// first natural frequency, its damping ratio, stories of very unequal stiffness. A floor's mass is
/// judged by the height of its story, the frequency by the mean height: from 2 m on as a
/// building's, below as that of a model on a table. `design`: theta in SI units, or empty.
std::vector<TextProblem> doubted_values(const TomlValue& document,
                                        const estimator::Structure& structure,
                                        const Eigen::VectorXd& design);

}  // namespace framewatch::daemon
