// SPDX-License-Identifier: MIT
#include "estimator/diagnose/spectra/whiteners.h"

#include <complex>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "estimator/simulate/random.h"

namespace framewatch::estimator {
namespace whiteners_test {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;

constexpr double kRounding = 1e-10;
constexpr Index kBinCounts[] = {1, 7, 8, 9, 17};  // around the kernels' eight
constexpr Index kEquations = 3, kAxes = 5;

/// A random operation with random noise.
struct Equations {
  std::vector<MatrixXcd> operation;
  MatrixXd noise;

  explicit Equations(Index bins, Index rows = kEquations, Index axes = kAxes) : noise(axes, bins) {
    Random random(static_cast<std::uint64_t>(100 + bins));
    for (Index b = 0; b < bins; ++b) {
      MatrixXcd d(rows, axes);
      for (Index i = 0; i < d.size(); ++i) d.data()[i] = {random.normal(), random.normal()};
      operation.push_back(d);
      for (Index a = 0; a < axes; ++a) noise(a, b) = 0.1 + random.uniform();
    }
  }

  std::function<MatrixXcd(Index)> of_bin() const {
    return [this](Index bin) { return operation[static_cast<std::size_t>(bin)]; };
  }

  MatrixXcd covariance(Index bin) const {
    const MatrixXcd& d = operation[static_cast<std::size_t>(bin)];
    return d * noise.col(bin).asDiagonal() * d.adjoint();
  }
};

std::vector<MatrixXcd> whole(const std::vector<Whitener>& all) {
  std::vector<MatrixXcd> out;
  for (const Whitener& one : all) out.push_back(one.whole());
  return out;
}

/// Returns the distance of L^-1 covariance L^-H from the identity.
double miss(const MatrixXcd& whitener, const MatrixXcd& covariance) {
  return (whitener * covariance * whitener.adjoint() -
          MatrixXcd::Identity(covariance.rows(), covariance.cols()))
      .cwiseAbs()
      .maxCoeff();
}

TEST(Whiteners, GiveTheNoiseOfEveryBinUnitCovariance) {
  for (const Index bins : kBinCounts) {
    const Equations e(bins);
    const std::vector<MatrixXcd> all = whole(whiteners(e.of_bin(), e.noise, {}));
    ASSERT_EQ(all.size(), static_cast<std::size_t>(bins));
    for (Index b = 0; b < bins; ++b)
      EXPECT_LT(miss(all[static_cast<std::size_t>(b)], e.covariance(b)), kRounding)
          << b << " of " << bins;
  }
}

TEST(Whiteners, AreLowerTrianglesWithAPositiveDiagonal) {
  const Equations e(9);
  for (const MatrixXcd& w : whole(whiteners(e.of_bin(), e.noise, {}))) {
    EXPECT_TRUE(w.isLowerTriangular(0.0));
    EXPECT_GT(w.diagonal().real().minCoeff(), 0);
    EXPECT_EQ(w.diagonal().imag().cwiseAbs().maxCoeff(), 0);
  }
}

TEST(Whiteners, AreOneOverTheDeviationForOneEquation) {
  const Equations e(3, 1, 2);
  const std::vector<MatrixXcd> all = whole(whiteners(e.of_bin(), e.noise, {}));
  for (std::size_t b = 0; b < all.size(); ++b)
    EXPECT_NEAR(all[b](0, 0).real(),
                1 / std::sqrt(e.covariance(static_cast<Index>(b))(0, 0).real()), kRounding);
}

TEST(Whiteners, PushedForcesAddTheirCovariance) {
  constexpr double kSize = 1e3;
  const Equations e(9);
  const Eigen::Vector3d at(0, 1, 0.5);
  const MatrixXd pushed = kSize * at * at.transpose();
  const std::vector<MatrixXcd> all = whole(whiteners(e.of_bin(), e.noise, pushed));
  ASSERT_EQ(all.size(), 9U);
  for (Index b = 0; b < 9; ++b) {
    const MatrixXcd sensors = e.covariance(b);
    const double mean = sensors.diagonal().real().mean();
    EXPECT_LT(miss(all[static_cast<std::size_t>(b)], sensors + mean * pushed.cast<Complex>()),
              kRounding * kSize);
    // The part along the force has almost no weight.
    EXPECT_LT((all[static_cast<std::size_t>(b)] * at).squaredNorm() * mean, 1.01 / kSize);
  }
}

TEST(Whiteners, UnreadMotionsAreEliminated) {
  constexpr Index kHidden = 2;
  Equations e(9, 4, kAxes + kHidden);
  e.noise = e.noise.topRows(kAxes).eval();
  MatrixXd basis = MatrixXd::Identity(4, 4);
  basis.topLeftCorner(2, 2) << 0.8, 0.6, -0.6, 0.8;
  const ReadMotions motions{basis.leftCols(2), basis.rightCols(2)};
  const std::vector<MatrixXcd> all = whole(whiteners(e.of_bin(), e.noise, {}, motions));
  ASSERT_EQ(all.size(), 9U);
  for (Index b = 0; b < 9; ++b) {
    const auto at = static_cast<std::size_t>(b);
    const MatrixXcd hidden = e.operation[at].rightCols(kHidden), w = all[at];
    EXPECT_EQ(w.bottomRows(kHidden).norm(), 0);
    EXPECT_LT((w * hidden).norm(), kRounding * w.norm() * hidden.norm());
    const MatrixXcd d = e.operation[at].leftCols(kAxes);
    const MatrixXcd kept = w.topRows(2) * d * e.noise.col(b).cwiseSqrt().asDiagonal();
    EXPECT_LT((kept * kept.adjoint() - MatrixXcd::Identity(2, 2)).norm(), kRounding);
  }
}

TEST(Whiteners, DoNotExistIfAnEquationHasNoNoise) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const Index bad : {0, 8, 10}) {
    Equations silent(11), dependent(11, 2), unknown(11);
    const auto at = static_cast<std::size_t>(bad);
    silent.operation[at].row(1).setZero();
    EXPECT_TRUE(whiteners(silent.of_bin(), silent.noise, {}).empty()) << bad;
    unknown.operation[at](2, 2) = kNan;
    EXPECT_TRUE(whiteners(unknown.of_bin(), unknown.noise, {}).empty()) << bad;
    unknown = Equations(11);
    unknown.noise(3, bad) = kNan;
    EXPECT_TRUE(whiteners(unknown.of_bin(), unknown.noise, {}).empty()) << bad;
    dependent.noise.col(bad).setZero();
    EXPECT_TRUE(whiteners(dependent.of_bin(), dependent.noise, {}).empty()) << bad;
  }
}

using Eigen::VectorXcd;

constexpr double kExact = 1e-12;

/// Below and above the size from which only a triangle is stored, including sizes that are not
/// multiples of the block.
constexpr Index kSizes[] = {1, 3, 24, 29, 40};

MatrixXcd random_matrix(Index equations, bool triangular) {
  Random random(static_cast<std::uint64_t>(equations));
  MatrixXcd out = MatrixXcd::Zero(equations, equations);
  for (Index i = 0; i < equations; ++i)
    for (Index j = 0; j < (triangular ? i + 1 : equations); ++j)
      out(i, j) = Complex(random.normal(), random.normal());
  return out;
}

TEST(Whitener, ReturnsItsMatrix) {
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

}  // namespace whiteners_test

}  // namespace framewatch::estimator
