#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/structure/parameter_table.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// How much ground motion shears each floor panel: its largest deformation as a share of the
/// largest frame deformation, over ground motion along x, y and obliquely at the natural
/// frequencies up to the twelfth. Order of the panel stiffnesses in theta. Zero up to rounding on a
/// symmetric plan: there no record identifies the panel.
std::vector<double> panel_excitation(const Structure& structure, const ParameterTable& table,
                                     const Eigen::VectorXd& theta);

}  // namespace framewatch::estimator
