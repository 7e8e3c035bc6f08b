#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/identify/floor_layout.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/structure.h"

namespace framewatch {

/// A start for buildings whose drawings say nothing: a uniform shear building with a period of
/// 0.1 s per story, panels as stiff as the mean frame, 2 % damping. theta order, SI.
Eigen::VectorXd guessed_design(const Structure& structure, const ParameterTable& table);

/// The design the filters should be tuned to after a window: `design` times the identified ratios,
/// each trusted as far as its standard error allows, at most a factor of 5 away; parameters the
/// window does not show follow the median of their kind.
/// ratio, std_error: internal order, relative to `design`; shown: whether the window shows it.
Eigen::VectorXd retuned_design(const FloorLayout& layout, const ParameterTable& table,
                               const Eigen::VectorXd& design, const std::vector<double>& ratio,
                               const std::vector<double>& std_error,
                               const std::vector<bool>& shown);

}  // namespace framewatch
