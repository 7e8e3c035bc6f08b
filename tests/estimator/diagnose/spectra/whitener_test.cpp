#include "estimator/diagnose/spectra/whiteners.h"

#include <complex>
#include <limits>

#include <gtest/gtest.h>

#include "estimator/simulate/random.h"

namespace framewatch::estimator {
namespace whitener_test {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::VectorXcd;

constexpr double kExact = 1e-12;

/// Below and above the number of equations from which only a triangle is kept, and numbers that are
/// no multiple of those that are worked on together.
constexpr Index kSizes[] = {1, 3, 24, 29, 40};

MatrixXcd random_matrix(Index equations, bool triangular) {
  Random random(static_cast<std::uint64_t>(equations));
  MatrixXcd out = MatrixXcd::Zero(equations, equations);
  for (Index i = 0; i < equations; ++i)
    for (Index j = 0; j < (triangular ? i + 1 : equations); ++j)
      out(i, j) = Complex(random.normal(), random.normal());
  return out;
}

TEST(Whitener, IsTheMatrixThatItWasMadeOf) {
  for (const bool triangular : {true, false})
    for (const Index n : kSizes) {
      const MatrixXcd whole = random_matrix(n, triangular);
      const Whitener whitener(whole);
      EXPECT_EQ(whitener.equations(), n);
      EXPECT_EQ(whitener.whole(), whole);
      EXPECT_NEAR(whitener.squared_norm(), whole.squaredNorm(), kExact * whole.squaredNorm());
      const VectorXcd x = random_matrix(n, false).col(0);
      EXPECT_LT((whitener.times(x) - whole * x).norm(), kExact * whole.norm() * x.norm());
      EXPECT_LT((whitener.adjoint_times(x) - whole.adjoint() * x).norm(),
                kExact * whole.norm() * x.norm());
    }
}

TEST(Whitener, MetricIsItsSquare) {
  for (const bool triangular : {true, false})
    for (const Index n : kSizes) {
      const MatrixXcd whole = random_matrix(n, triangular), expected = whole.adjoint() * whole;
      EXPECT_LT((Whitener(whole).metric() - expected).norm(), kExact * expected.norm())
          << n << " equations";
    }
}

TEST(Whitener, IsFiniteUnlessANumberIsNot) {
  for (const Index n : kSizes) {
    MatrixXcd whole = random_matrix(n, true);
    EXPECT_TRUE(Whitener(whole).is_finite());
    whole(n - 1, 0) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(Whitener(whole).is_finite());
  }
}

}  // namespace whitener_test
}  // namespace framewatch::estimator
