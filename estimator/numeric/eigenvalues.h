#pragma once

#include <Eigen/Core>

namespace framewatch::estimator {

// Eigen's eigenvalue problems and matrix functions behind plain functions (see solve.h).

/// values: ascending; vectors: in columns, empty where only values were asked for.
struct RealEigen {
  bool good = false;
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

/// a x = lambda x of a symmetric a.
RealEigen symmetric_eigen(const Eigen::MatrixXd& a);
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& a);
/// a x = lambda b x, a symmetric, b symmetric and positive; vectors of x' b x = 1.
RealEigen generalized_eigen(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
Eigen::VectorXd generalized_eigenvalues(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

struct ComplexEigen {
  bool good = false;
  Eigen::VectorXcd values;
  Eigen::MatrixXcd vectors;
};

/// a x = lambda x of any real square a.
ComplexEigen general_eigen(const Eigen::MatrixXd& a);
Eigen::VectorXcd general_eigenvalues(const Eigen::MatrixXd& a);

/// matrix = left diag(values) right', values descending, thin.
struct SingularValues {
  Eigen::VectorXd values;
  Eigen::MatrixXd left, right;
};
SingularValues singular_values(const Eigen::MatrixXd& matrix);

/// e^square, by scaling and squaring.
Eigen::MatrixXd matrix_exponential(const Eigen::MatrixXd& square);

}  // namespace framewatch::estimator
