// SPDX-License-Identifier: MIT
#include "estimator/identify/solve/batch_least_squares.h"

#include "estimator/numeric/solve.h"
#include "estimator/structure/matrices.h"

namespace framewatch::estimator {

Eigen::VectorXd batch_least_squares(const Structure& structure, const ParameterTable& table,
                                    const MotionHistory& motion) {
  const Eigen::Index elements = table.elements();
  Eigen::MatrixXd b = Eigen::MatrixXd::Zero(structure.degrees_of_freedom(), elements);
  for (const Element& element : estimator::elements(structure, table))
    for (const auto& [dof, coefficient] : element.b) b(dof, element.stiffness) = coefficient;

  // Elements are of rank one, so H'H is the Hadamard product of b'b and the moments of the
  // deformations.
  Eigen::MatrixXd deformation(motion.disp_rel.rows(), 2 * elements);
  deformation << motion.disp_rel * b, motion.vel_rel * b;
  const Eigen::MatrixXd inertia =
      -motion.accel_abs *
      assemble(structure, table, Eigen::VectorXd::Ones(table.size())).mass.asDiagonal() * b;
  const Eigen::MatrixXd shared = b.transpose() * b;
  const Eigen::MatrixXd normal =
      shared.replicate(2, 2).cwiseProduct(deformation.transpose() * deformation);
  const Eigen::VectorXd right =
      deformation.cwiseProduct(inertia.replicate(1, 2)).colwise().sum().transpose();

  const Eigen::VectorXd scale = normal.diagonal().cwiseSqrt().cwiseInverse();
  if (!scale.allFinite()) return {};
  const Ldlt factor(scale.asDiagonal() * normal * scale.asDiagonal());
  if (!factor.good() || !factor.positive()) return {};
  const Eigen::VectorXd theta =
      scale.cwiseProduct(factor.solve(Eigen::VectorXd(scale.cwiseProduct(right))));
  return theta.allFinite() ? theta : Eigen::VectorXd();
}

}  // namespace framewatch::estimator
