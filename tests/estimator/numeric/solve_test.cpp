// SPDX-License-Identifier: MIT
#include "estimator/numeric/solve.h"

#include <gtest/gtest.h>

namespace framewatch::estimator {
namespace solve_test {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kRounding = 1e-12;

TEST(SolvePositive, SolvesPositiveMatricesAndOthersOfAnySize) {
  for (const Eigen::Index size : {3, 250})
    for (const double sign : {1.0, -1.0}) {
      MatrixXd matrix = MatrixXd::Identity(size, size) * 4;
      matrix.diagonal(1).setConstant(1);
      matrix.diagonal(-1).setConstant(1);
      matrix(1, 1) *= sign;
      const VectorXd expected = VectorXd::LinSpaced(size, -1, 2);
      EXPECT_LT((solve_positive(matrix, matrix * expected) - expected).norm(),
                kRounding * expected.norm());
    }
}

}  // namespace solve_test
}  // namespace framewatch::estimator
