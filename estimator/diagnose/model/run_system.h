#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/model/model.h"

namespace framewatch::estimator {

/// Equation of motion of a model's free run, M y'' + C y' + K y = P u. Coordinates: the building's,
/// then one for every resonator. Inputs u: the driving axes (base acceleration, m/s^2, or a
/// measured force, N), then the force, N, of every effect that is an element law or a harmonic
/// force.
struct RunSystem {
  Eigen::MatrixXd mass, damping, stiffness;  ///< coordinates x coordinates
  Eigen::MatrixXd inputs;                    ///< P, coordinates x inputs
};

/// Returns the equation of motion of a model. driving: axes that drive the run.
RunSystem run_system(const Plant& plant, const Model& model,
                     const std::vector<Eigen::Index>& driving);

}  // namespace framewatch::estimator
