// SPDX-License-Identifier: MIT
// Eigen multiplies and adds in one order on every architecture (cmake/SameBits.cmake). The digest
// is that of amd64 with SSE2.
#include <bit>
#include <complex>
#include <cstdint>

#include <gtest/gtest.h>
#include <Eigen/Core>

#include "estimator/simulate/random.h"

namespace framewatch::estimator {
namespace eigen_order_test {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;

/// One block of Eigen's, whatever the size of the processor's first cache.
constexpr int kLargest = 200;

class Digest {
 public:
  template <typename Matrix>
  void add(const Matrix& matrix) {
    const auto* numbers = reinterpret_cast<const double*>(matrix.data());
    const Index count = matrix.size() * static_cast<Index>(sizeof(*matrix.data()) / sizeof(double));
    for (Index i = 0; i < count; ++i)
      value_ = (value_ ^ std::bit_cast<std::uint64_t>(numbers[i])) * 1099511628211u;
  }
  void add(double number) { add(Eigen::Matrix<double, 1, 1>(number)); }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 1469598103934665603u;  // FNV-1a by words
};

MatrixXd random_matrix(Index rows, Index columns, Random& random) {
  MatrixXd out(rows, columns);
  for (double& value : out.reshaped()) value = random.uniform() - 0.5;
  return out;
}

TEST(EigenOrder, IsThatOfAmd64) {
  Digest digest;
  Random random(7);
  for (const int n : {1, 2, 3, 4, 5, 6, 7, 9, 14, 23, 51, 70, kLargest})
    for (const int inner : {1, 3, 8, 21, 64, kLargest}) {
      const MatrixXd a = random_matrix(n, inner, random), b = random_matrix(inner, n, random);
      digest.add(MatrixXd(a * b));
      digest.add(MatrixXd(a * a.transpose()));
      digest.add(MatrixXd(b.transpose() * b));
      digest.add(Eigen::VectorXd(a * b.col(0)));
      digest.add(Eigen::VectorXd(b.transpose() * b.col(0)));
      digest.add(a.row(0).dot(b.col(0)));
      digest.add(a.squaredNorm());
      digest.add(a.sum());
      MatrixXd square = MatrixXd::Zero(n, n);
      square.selfadjointView<Eigen::Lower>().rankUpdate(a);
      digest.add(square);
      square = 0.1 * square + MatrixXd::Identity(n, n);
      digest.add(MatrixXd(square.triangularView<Eigen::Lower>().solve(a)));
      const MatrixXcd c = a + std::complex<double>(0, 1) * b.transpose();
      digest.add(MatrixXcd(c * c.adjoint()));
      digest.add(Eigen::VectorXcd(c * c.row(0).transpose()));
      digest.add(MatrixXcd(c.array() / (c.array() + 1.5)));
    }
  EXPECT_EQ(digest.value(), 0x4d79a36aa34f20a8u);
}

}  // namespace eigen_order_test
}  // namespace framewatch::estimator
