// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/structure/parameter_table.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// Returns the lowest undamped natural frequency, Hz. For a large building it costs a few solutions
/// of banded equations, much less than all frequencies.
double lowest_frequency_hz(const Structure& structure, const ParameterTable& table,
                           const Eigen::VectorXd& theta);

/// Returns the undamped natural frequencies, ascending, Hz. Dense: the cost is the cube of the
/// degrees of freedom.
std::vector<double> natural_frequencies_hz(const Structure& structure, const ParameterTable& table,
                                           const Eigen::VectorXd& theta);

/// Returns theta with its stiffnesses and with damping proportional to them: C = (2 h / w1) K,
/// where w1 is the lowest undamped natural circular frequency and h is damping_ratio. The paper's
/// examples set damping this way.
Eigen::VectorXd with_proportional_damping(const Structure& structure, const ParameterTable& table,
                                          Eigen::VectorXd theta, double damping_ratio);

/// Returns how much ground motion shears each floor panel: its largest deformation over the largest
/// frame deformation, for ground motion along x, y and obliquely at the first twelve natural
/// frequencies. The order is that of the panel stiffnesses in theta. A symmetric plan gives zero up
/// to rounding; no record identifies its panels.
std::vector<double> panel_excitation(const Structure& structure, const ParameterTable& table,
                                     const Eigen::VectorXd& theta);

}  // namespace framewatch::estimator
