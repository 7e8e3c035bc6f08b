// SPDX-License-Identifier: MIT
#include "estimator/diagnose/spectra/weights.h"

#include <cmath>
#include <complex>

#include <gtest/gtest.h>

#include "estimator/numeric/kernels.h"
#include "estimator/simulate/random.h"

namespace framewatch::estimator {
namespace weights_test {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kEquations = 3, kBins = 40;

/// Arbitrary lower triangles, and an oscillator at the second equation.
struct Some {
  std::vector<MatrixXcd> whitener;
  VectorXd w = VectorXd::LinSpaced(kBins, 2.0, 9.0);
  HiddenOscillator hidden{VectorXd::Unit(kEquations, 1), Eigen::VectorXcd(kBins)};
  Random random{11};

  Some() {
    for (Index b = 0; b < kBins; ++b) {
      MatrixXcd one = MatrixXcd::Zero(kEquations, kEquations);
      for (Index i = 0; i < kEquations; ++i)
        for (Index j = 0; j <= i; ++j)
          one(i, j) =
              i == j ? Complex(2 + random.uniform(), 0) : Complex(random.normal(), random.normal());
      whitener.push_back(one);
      hidden.transmissibility[b] = 30.0 / (30.0 - w[b] * w[b] + Complex(0, 0.5 * w[b]));
    }
  }
};

std::vector<Whitener> whiteners_of(const std::vector<MatrixXcd>& matrices) {
  std::vector<Whitener> out;
  for (const MatrixXcd& one : matrices) out.emplace_back(one);
  return out;
}

TEST(Weights, ForcesMatchTheirWhitenedRows) {
  constexpr double kRounding = 1e-10;
  const Some some;
  MatrixXd read = MatrixXd::Zero(kEquations, 2);
  read << 0.8, 0, 0.6, 0, 0, 1;
  // Rows of zeros stand for eliminated equations.
  std::vector<MatrixXcd> eliminated;
  for (const MatrixXcd& w : some.whitener) {
    eliminated.push_back(MatrixXcd::Zero(kEquations, kEquations));
    eliminated.back().topRows(2) = w.topLeftCorner(2, 2) * read.transpose().cast<Complex>().eval();
    eliminated.back().topRows(2) += MatrixXcd::Ones(2, 1) * Eigen::RowVector3cd(0.6, -0.8, 0);
  }
  const Weights all(whiteners_of(some.whitener), some.w, {}),
      of_some(whiteners_of(eliminated), some.w, {}, read);
  Eigen::VectorXcd rows(kEquations);
  rows << Complex(1, 2), Complex(-3, 0.5), Complex(0, 1);
  for (const Index b : {0, 7, 39}) {
    EXPECT_LT((all.whitener(b).whole() * all.forces_of(b, rows) - rows).norm(), kRounding);
    const Eigen::VectorXcd forces = of_some.forces_of(b, rows);
    EXPECT_LT((of_some.whitener(b).whole() * forces - rows).head(2).norm(), kRounding);
    EXPECT_LT(std::abs(Complex(0.6 * forces[0] - 0.8 * forces[1])), kRounding);
  }
}

/// Large buildings with unread motions have whiteners that are not triangular.
TEST(Weights, StayCompleteWithUnreadMotions) {
  constexpr Index kLarge = 30, kRead = 4;
  Random random{5};
  const auto any = [&](Index rows, Index columns) {
    return MatrixXcd::NullaryExpr(
               rows, columns,
               [&](Index, Index) { return Complex(random.normal(), random.normal()); })
        .eval();
  };
  MatrixXcd whitener = MatrixXcd::Zero(kLarge, kLarge);
  whitener.topRows(kRead) = any(kRead, kLarge);
  const VectorXd w = VectorXd::LinSpaced(2, 2.0, 9.0);
  const Weights weights(whiteners_of({whitener, 2 * whitener}), w, {},
                        MatrixXd::Identity(kLarge, kRead));
  const MatrixXcd forces = any(kLarge, 2);
  const VectorXd rows = weights.whitened(forces);
  const MatrixXcd turned = weights.turned_back(rows);
  for (const Index b : {0, 1}) {
    const Eigen::VectorXcd one = static_cast<double>(b + 1) * whitener * forces.col(b);
    const double size = one.norm();
    EXPECT_LT((rows.segment(2 * kLarge * b, kLarge) - one.real()).norm(), 1e-12 * size);
    EXPECT_LT((rows.segment(2 * kLarge * b + kLarge, kLarge) - one.imag()).norm(), 1e-12 * size);
    EXPECT_LT((turned.col(b) - static_cast<double>(b + 1) * whitener.adjoint() * one).norm(),
              1e-10 * size);
  }
}

/// Returns the end terms' columns of docs/equations.md (32), each of length one.
MatrixXd columns_of_ends(const Some& some) {
  MatrixXd out(2 * kEquations * kBins, 4 * kEquations + 2);
  const double middle = std::sqrt(some.w[0] * some.w[kBins - 1]);
  for (Index b = 0; b < kBins; ++b) {
    const MatrixXcd& l = some.whitener[static_cast<std::size_t>(b)];
    const Complex jr(0, some.w[b] / middle);
    MatrixXcd here(kEquations, out.cols());
    here.leftCols(kEquations) = -l / (jr * jr);
    here.middleCols(kEquations, kEquations) = l / jr;
    here.middleCols(2 * kEquations, kEquations) = l;
    here.middleCols(3 * kEquations, kEquations) = l * jr;
    here.col(4 * kEquations) = l.col(1) * some.hidden.transmissibility[b];
    here.col(4 * kEquations + 1) = here.col(4 * kEquations) * jr;
    out.middleRows(2 * kEquations * b, kEquations) = here.real();
    out.middleRows(2 * kEquations * b + kEquations, kEquations) = here.imag();
  }
  return out.colwise().normalized();
}

TEST(Weights, EndTermsMatchTheEquations) {
  constexpr double kRounding = 1e-12;
  Some some;
  const Weights weights(whiteners_of(some.whitener), some.w, {some.hidden});
  const MatrixXd ends = columns_of_ends(some);
  ASSERT_EQ(weights.ends(), ends.cols());
  EXPECT_LT((weights.ends_square() - ends.transpose() * ends).cwiseAbs().maxCoeff(), kRounding);
  const RowMatrix all = RowMatrix::Identity(2 * kEquations, 2 * kEquations);
  RowMatrix sum = RowMatrix::Zero(ends.cols(), kernels::kBins);
  RowMatrix rows(2 * kEquations, kernels::kBins), forces, along;
  MatrixXd wanted = MatrixXd::Zero(ends.cols(), rows.cols());
  for (Index b = 0; b < kBins; ++b) {
    const MatrixXd here = ends.middleRows(2 * kEquations * b, 2 * kEquations);
    EXPECT_LT((weights.times_ends(b, all) - here).cwiseAbs().maxCoeff(), kRounding);
    for (Index i = 0; i < rows.size(); ++i) rows.data()[i] = some.random.normal();
    weights.put_unit_forces(b, true, forces);
    multiply(forces, rows, along);
    weights.add_shares(b, along, sum);
    wanted += here.transpose() * rows;
  }
  EXPECT_LT((sum - wanted).cwiseAbs().maxCoeff(), kRounding * kBins);
}

TEST(Weights, EndTermsAreProjectedOut) {
  constexpr double kLeft = 1e-6;
  Some some;
  const Weights weights(whiteners_of(some.whitener), some.w, {some.hidden});
  const MatrixXd ends = columns_of_ends(some);
  VectorXd rows(ends.rows());
  for (double& r : rows) r = some.random.normal();
  const VectorXd rest = weights.without_ends(rows);
  EXPECT_LT((ends.transpose() * rest).cwiseAbs().maxCoeff(), kLeft);
  EXPECT_LT((weights.without_ends(rest) - rest).norm(), kLeft);
  EXPECT_LT(weights.without_ends(ends * VectorXd::Ones(ends.cols())).norm(), kLeft);
}

TEST(Weights, EndTermsExplainASingleBin) {
  constexpr double kLeft = 1e-6;
  Some some;
  some.hidden.transmissibility.conservativeResize(1);
  const Weights weights(whiteners_of({some.whitener.front()}), some.w.head(1), {some.hidden});
  EXPECT_EQ(weights.bins(), 1);
  EXPECT_LT(weights.without_ends(VectorXd::Ones(2 * kEquations)).norm(), kLeft);
}

/// X of a whitener W: unit forces give its real and imaginary parts, forces of -j the imaginary
/// parts and minus the real parts.
TEST(Weights, UnitForcesAreTheWhitenerInRealParts) {
  const Some some;
  const Weights weights(whiteners_of(some.whitener), some.w, {});
  EXPECT_EQ(weights.ends(), 4 * kEquations);
  RowMatrix forces, transposed;
  for (const Index b : {Index{0}, kBins - 1}) {
    weights.put_unit_forces(b, false, forces);
    weights.put_unit_forces(b, true, transposed);
    MatrixXd expected(2 * kEquations, 2 * kEquations);
    const MatrixXcd w = weights.whitener(b).whole();
    expected << w.real(), w.imag(), w.imag(), -w.real();
    EXPECT_EQ(forces.leftCols(2 * kEquations), expected);
    EXPECT_EQ(transposed.leftCols(2 * kEquations), expected.transpose());
    EXPECT_TRUE(forces.rightCols(forces.cols() - 2 * kEquations).isZero(0));
  }
}

TEST(Weights, WhitensForcesAndTurnsRowsBack) {
  constexpr double kExact = 1e-12;
  Random random(7);
  for (const Index equations : {3, 30}) {  // dense and triangular
    std::vector<MatrixXcd> whiteners;
    MatrixXcd forces(equations, kBins);
    VectorXd rows(2 * equations * kBins);
    for (Index b = 0; b < kBins; ++b) {
      MatrixXcd one = MatrixXcd::Zero(equations, equations);
      for (Index i = 0; i < equations; ++i)
        for (Index j = 0; j <= i; ++j) one(i, j) = Complex(random.normal(), random.normal());
      one.diagonal().array() += 5;
      whiteners.push_back(one);
      for (Index i = 0; i < equations; ++i)
        forces(i, b) = Complex(random.normal(), random.normal());
    }
    for (Index i = 0; i < rows.size(); ++i) rows[i] = random.normal();
    const Weights weights(whiteners_of(whiteners), VectorXd::LinSpaced(kBins, 2, 9), {});
    const VectorXd whitened = weights.whitened(forces);
    const MatrixXcd back = weights.turned_back(rows);
    for (Index b = 0; b < kBins; ++b) {
      const Eigen::VectorXcd row = weights.whitener(b).whole() * forces.col(b);
      VectorXd expected(2 * equations);
      expected << row.real(), row.imag();
      EXPECT_LT((whitened.segment(2 * equations * b, 2 * equations) - expected).norm(),
                kExact * expected.norm());
      const Eigen::VectorXcd of_bin =
          rows.segment(2 * equations * b, equations) +
          Complex(0, 1) * rows.segment(2 * equations * b + equations, equations);
      EXPECT_LT((back.col(b) - weights.whitener(b).whole().adjoint() * of_bin).norm(),
                kExact * of_bin.norm() * weights.whitener(b).whole().norm());
    }
  }
}

}  // namespace weights_test
}  // namespace framewatch::estimator
