// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "estimator/identify/elements/floor_layout.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// Returns a fixed random sign, 1 or -1, the same on every run and machine (splitmix64).
inline double fixed_sign(int row, int column) {
  std::uint64_t z = (static_cast<std::uint64_t>(row) << 20) + static_cast<std::uint64_t>(column);
  z += 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  return ((z ^ (z >> 31)) & 1) != 0 ? 1.0 : -1.0;
}

/// Returns a theta0 to start from without a configured design: a uniform shear building with a
/// period of 0.1 s per story, panels as stiff as the mean frame, and 2 % damping. theta order, SI.
Eigen::VectorXd guessed_design(const Structure& structure, const ParameterTable& table);

/// Returns how far to follow an identified ratio > 0 with a relative standard error:
/// docs/equations.md (23).
double trusted_ratio(double ratio, double std_error);

/// Buffers of retuned_design(), so that it does not allocate.
struct RetuningWork {
  explicit RetuningWork(int parameters);
  std::vector<double> factor, seen;
};

/// Computes the parameters that the filters should be tuned to after a window. They are the present
/// ones, `design`, times the identified ratios. Each ratio is trusted as far as its standard error
/// allows, within a factor of 5. Parameters that the window does not show follow the median of
/// their kind. ratio, std_error: internal order, relative to `design`. shown: flags of the unknowns
/// that the window shows. out: as long as `design`.
void retuned_design(const FloorLayout& layout, const ParameterTable& table,
                    const Eigen::VectorXd& design, const std::vector<double>& ratio,
                    const std::vector<double>& std_error, const std::vector<std::uint8_t>& shown,
                    RetuningWork& work, Eigen::VectorXd& out);

/// Fixed random errors of a design, each as large as its tolerance (design_tolerance). The standard
/// error includes how far prior and noise pull the solution toward a design with such errors.
/// docs/equations.md, batch means.
class PerturbedDesigns {
 public:
  static constexpr int kCount = 20;

  explicit PerturbedDesigns(const FloorLayout& layout);

  /// Returns the relative errors of the front unknowns of a floor, unknowns x kCount, row-major.
  const double* floor(int floor) const {
    return &error_[static_cast<std::size_t>(floor * own_ * kCount)];
  }

 private:
  int own_;
  std::vector<double> error_;
};

}  // namespace framewatch::estimator
