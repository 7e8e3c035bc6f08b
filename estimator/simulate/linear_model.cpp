#include "estimator/simulate/linear_model.h"

namespace framewatch::estimator {

Eigen::MatrixXd LinearModel::stiffness() const {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(mass.size(), mass.size());
  for (const LinearElement& e : linear) out += e.stiffness * e.b * e.b.transpose();
  return out;
}

Eigen::MatrixXd LinearModel::damping() const {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(mass.size(), mass.size());
  for (const LinearElement& e : linear) out += e.damping * e.b * e.b.transpose();
  return out;
}

}  // namespace framewatch::estimator
