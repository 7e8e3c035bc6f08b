#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "estimator/identify/elements/floor_layout.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// The theta0 to start from when the configuration gives no design: a uniform shear building with a
/// period of 0.1 s per story, panels as stiff as the mean frame, 2 % damping. theta order, SI.
Eigen::VectorXd guessed_design(const Structure& structure, const ParameterTable& table);

/// How far to follow an identified ratio > 0 of a relative standard error: docs/equations.md (23).
double trusted_ratio(double ratio, double std_error);

/// What retuned_design() works with, so that it need not allocate.
struct RetuningWork {
  explicit RetuningWork(int parameters);
  std::vector<double> factor, seen;
};

/// The parameters that the filters should be tuned to after a window: `design`, what they are tuned
/// to now, times the identified ratios, each trusted as far as its standard error allows, at most a
/// factor of 5 away; parameters the window does not show follow the median of their kind.
/// ratio, std_error: internal order, relative to `design`; shown: whether the window shows it.
/// out: as long as `design`.
void retuned_design(const FloorLayout& layout, const ParameterTable& table,
                    const Eigen::VectorXd& design, const std::vector<double>& ratio,
                    const std::vector<double>& std_error, const std::vector<std::uint8_t>& shown,
                    RetuningWork& work, Eigen::VectorXd& out);

}  // namespace framewatch::estimator
