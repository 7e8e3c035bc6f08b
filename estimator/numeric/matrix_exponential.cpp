#include <unsupported/Eigen/MatrixFunctions>

#include "estimator/numeric/eigenvalues.h"

namespace framewatch::estimator {

Eigen::MatrixXd matrix_exponential(const Eigen::MatrixXd& square) {
  return square.exp();
}

}  // namespace framewatch::estimator
