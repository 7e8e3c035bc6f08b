#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "estimator/identify/elements/floor_layout.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// A fixed random sign, 1 or -1: the same on every run and machine (splitmix64).
inline double fixed_sign(int row, int column) {
  std::uint64_t z = (static_cast<std::uint64_t>(row) << 20) + static_cast<std::uint64_t>(column);
  z += 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  return ((z ^ (z >> 31)) & 1) != 0 ? 1.0 : -1.0;
}

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

/// Fixed random errors of a design, each as large as its tolerance (design_tolerance): how much
/// prior and noise bias the solution toward a design with such errors is part of the standard
/// error. docs/equations.md, batch means.
class PerturbedDesigns {
 public:
  static constexpr int kCount = 20;

  explicit PerturbedDesigns(const FloorLayout& layout);

  /// Relative error of every front unknown of a floor, row-major, unknowns x kCount.
  const double* floor(int floor) const {
    return &error_[static_cast<std::size_t>(floor * own_ * kCount)];
  }

 private:
  int own_;
  std::vector<double> error_;
};

}  // namespace framewatch::estimator
