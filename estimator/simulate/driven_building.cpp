#include "estimator/simulate/driven_building.h"

#include "estimator/structure/matrices.h"

namespace framewatch::estimator {

Inputs ground_inputs(const Structure& structure) {
  const Eigen::MatrixXd influence = ground_influence(structure);
  return {influence, Eigen::MatrixXd::Zero(influence.rows(), influence.cols())};
}

}  // namespace framewatch::estimator
