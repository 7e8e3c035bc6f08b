// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "estimator/structure/group_design.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// One mode of a damped building: an eigenvalue lambda of M y'' + C y' + K y = 0 with a positive
/// imaginary part, and its shape. Standard errors are NaN if the parameters have no covariance.
struct NaturalMode {
  double frequency_hz = 0;                           ///< |lambda| / (2 pi)
  double damping_ratio = 0;                          ///< -Re lambda / |lambda|
  double frequency_error_hz = 0, damping_error = 0;  ///< standard errors
  /// By degree of freedom (Structure::dof); the entry with the largest absolute value is 1.
  Eigen::VectorXcd shape;
  /// Standard error of the shape's real part. NaN for modes with equal frequencies, whose shapes
  /// are determined only as a subspace.
  Eigen::VectorXd shape_error;
  /// Shares of the kinetic energy: translation of floors along x, along y, and the rest, which is
  /// rotation and shear of floors.
  std::array<double, 3> motion{};
  /// The modes first_equal..last_equal have equal frequencies: they differ by less than two
  /// standard errors of the difference, or by rounding. Both are the mode's index if it is alone.
  int first_equal = 0, last_equal = 0;
};

/// The modes of a building, by ascending frequency.
struct NaturalModes {
  std::vector<NaturalMode> modes;
  int overdamped = 0;  ///< pairs of real eigenvalues, which have no frequency
};

/// Most degrees of freedom of natural_modes(): its cost is their cube.
inline constexpr int kMostModalFreedoms = 1200;

/// Returns the lowest modes. docs/equations.md (64)-(66).
///
/// table: of theta. theta: > 0, SI. design: what theta replaces, with the bending stiffness. Its
/// parameters remain where no parameter of theta describes an element. covariance: of theta; empty:
/// no standard errors. most: number of modes. shape_errors: false leaves NaN in
/// NaturalMode::shape_error, which cost most. Returns no modes if the building has more than
/// kMostModalFreedoms degrees of freedom, or if the eigenvalues do not converge.
NaturalModes natural_modes(const Structure& structure, const ParameterTable& table,
                           const GroupDesign& design, const Eigen::VectorXd& theta,
                           const Eigen::MatrixXd& covariance = {}, int most = 24,
                           bool shape_errors = true);

}  // namespace framewatch::estimator
