// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// A mode as other modes are compared with it: its shape at the compared channels.
struct ComparedMode {
  double frequency_hz = 0;
  Eigen::VectorXcd shape;
  /// The modes of its list with its frequency; both its own index if it is alone.
  int first_equal = 0, last_equal = 0;
};

/// Returns the indices of the channels at which shapes are compared: accelerometers along x or y
/// above the base.
std::vector<std::size_t> compared_axes(const std::vector<SensorAxis>& axes);

/// Returns a matrix of compared channels x degrees of freedom: the motion that each measures.
Eigen::MatrixXd channel_weights(const Structure& structure, const std::vector<SensorAxis>& axes);

/// Returns the modal assurance criterion of two shapes, |a^H b|^2 / (a^H a b^H b): 1 if they are
/// equal up to a factor. NaN if one is zero or their sizes differ.
double mac(const Eigen::VectorXcd& a, const Eigen::VectorXcd& b);

/// Returns the modal assurance criterion of modes `a` of `as` and `b` of `bs`. For a mode with
/// equal frequencies it is the part of the other shape that lies in the subspace of all of them.
double mac(const std::vector<ComparedMode>& as, int a, const std::vector<ComparedMode>& bs, int b);

/// Returns for each of `as` the mode of `bs` that is most like it, -1: none. A mode of `bs` has at
/// most one partner. Partners have a MAC of at least 0.5 and a ratio of frequencies of at most 1.5.
std::vector<int> paired_modes(const std::vector<ComparedMode>& as,
                              const std::vector<ComparedMode>& bs);

}  // namespace framewatch::estimator
