// SPDX-License-Identifier: MIT
#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>

#include "estimator/gap/measured_inputs.h"
#include "estimator/simulate/linear_building.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// Motion of one axis above the base: degrees of freedom (Structure::dof) with weights.
using SeenMotion = std::vector<std::pair<int, double>>;

/// Computes what a change of the base's readings changes at the floors, by a linear model in steps
/// of one instant. It takes filtered readings and returns filtered motions, because a linear model
/// and a filter commute.
class BaseResponse {
 public:
  /// seen: by axis.
  BaseResponse(const Structure& structure, const ParameterTable& table,
               const Eigen::VectorXd& theta, const MeasuredInputs& inputs,
               const std::vector<SeenMotion>& seen, double rate_hz);

  /// Returns the axes that drive the model.
  const std::vector<Eigen::Index>& axes() const { return axes_; }
  /// Returns the absolute motion that one driving axis causes from rest, instants x all axes,
  /// m/s^2. reading: m/s^2 at every instant.
  Eigen::MatrixXd of(Eigen::Index axis, const Eigen::VectorXd& reading);

 private:
  LinearBuilding building_;
  std::vector<double> rest_;
  std::vector<Eigen::Index> axes_;
  Eigen::MatrixXd from_axes_;  ///< inputs x all axes
  std::vector<SeenMotion> seen_;
};

}  // namespace framewatch::estimator
