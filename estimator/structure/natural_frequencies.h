#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/structure/parameter_table.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// The lowest undamped natural frequency, Hz. Unlike all of them it takes a large building no
/// longer than a few solutions of its banded equations.
double lowest_frequency_hz(const Structure& structure, const ParameterTable& table,
                           const Eigen::VectorXd& theta);

/// Undamped natural frequencies, ascending, Hz. Dense: the cube of the degrees of freedom.
std::vector<double> natural_frequencies_hz(const Structure& structure, const ParameterTable& table,
                                           const Eigen::VectorXd& theta);

/// theta with every stiffness given and damping proportional to it, C = (2 h / w1) K, where w1 is
/// the lowest undamped natural circular frequency: how the paper's examples set damping.
Eigen::VectorXd with_proportional_damping(const Structure& structure, const ParameterTable& table,
                                          Eigen::VectorXd theta, double damping_ratio);

/// How much ground motion shears each floor panel: its largest deformation as a share of the
/// largest frame deformation, over ground motion along x, y and obliquely at the natural
/// frequencies up to the twelfth. Order of the panel stiffnesses in theta. Zero up to rounding on a
/// symmetric plan: there no record identifies the panel.
std::vector<double> panel_excitation(const Structure& structure, const ParameterTable& table,
                                     const Eigen::VectorXd& theta);

}  // namespace framewatch::estimator
