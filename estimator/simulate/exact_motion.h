#pragma once

#include <Eigen/Core>

#include "estimator/identify/solve/batch_least_squares.h"
#include "estimator/simulate/ground_motion.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// The exact response from rest, `rows` instants from time 0. No anti-alias filter: the equation of
/// motion holds at every instant. The ground motion is linear within steps of at most 1 ms.
MotionHistory exact_motion(const Structure& structure, const ParameterTable& table,
                           const Eigen::VectorXd& theta, const PlanMotion& motion, double rate_hz,
                           Eigen::Index rows);

}  // namespace framewatch::estimator
