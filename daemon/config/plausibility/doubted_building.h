// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include "daemon/base/toml_document.h"
#include "estimator/structure/structure.h"

namespace framewatch::daemon {

/// Returns warnings about valid values of [structure] that are implausible, each at its place, with
/// the plausible range and the likely mistake. Checks story heights, spans, mass per floor area,
/// first natural frequency, its damping ratio and stories of very unequal stiffness.
/// Stories (for the frequency: their mean height) below 2 m are judged as those of a shaking-table
/// model. `design`: theta in SI units, or empty.
std::vector<TextProblem> doubted_values(const TomlValue& document,
                                        const estimator::Structure& structure,
                                        const Eigen::VectorXd& design);

}  // namespace framewatch::daemon
