#include <cmath>
#include <complex>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "estimator/diagnose/law/law_parameter.h"
#include "estimator/diagnose/propose/needed_signal.h"
#include "estimator/simulate/random.h"

namespace framewatch::estimator {
namespace scalar_fit_test {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr Index kBins = 30;
constexpr double kRounding = 1e-8;  // the fit regularises by 1e-10

VectorXcd any_signal(Random& random) {
  VectorXcd out(kBins);
  for (Index b = 0; b < kBins; ++b) out[b] = {random.normal(), random.normal()};
  return out;
}

/// A record's needed force and columns that may explain it.
struct AnyRecord {
  NeededSignal needed;
  std::vector<VectorXcd> columns;

  AnyRecord(Random& random, std::size_t count) {
    needed.force = any_signal(random);
    needed.weight.resize(kBins);
    for (double& weight : needed.weight) weight = 0.5 + random.uniform();
    for (std::size_t c = 0; c < count; ++c) columns.push_back(any_signal(random));
  }

  /// Real and imaginary rows, each times the square root of its weight.
  VectorXd rows(const VectorXcd& signal) const {
    VectorXd out(2 * kBins);
    out << signal.real().cwiseProduct(needed.weight.cwiseSqrt()),
        signal.imag().cwiseProduct(needed.weight.cwiseSqrt());
    return out;
  }
};

TEST(ScalarFit, IsTheWeightedLeastSquaresOfAllRecords) {
  constexpr std::size_t kColumns = 3;
  Random random(5);
  const AnyRecord one(random, kColumns), two(random, kColumns);
  Eigen::MatrixXd x(4 * kBins, static_cast<Index>(kColumns));
  for (std::size_t c = 0; c < kColumns; ++c)
    x.col(static_cast<Index>(c)) << one.rows(one.columns[c]), two.rows(two.columns[c]);
  VectorXd y(4 * kBins);
  y << one.rows(one.needed.force), two.rows(two.needed.force);
  const VectorXd wanted = (x.transpose() * x).llt().solve(x.transpose() * y);
  const ScalarFit fit = scalar_fit({one.needed, two.needed}, {one.columns, two.columns});
  EXPECT_LT((fit.coefficients - wanted).norm(), kRounding);
  EXPECT_NEAR(fit.misfit, (y - x * wanted).squaredNorm(), kRounding * y.squaredNorm());
}

TEST(ScalarFit, CoefficientsAreReal) {
  // A column turned by a quarter explains nothing of the force.
  Random random(6);
  AnyRecord record(random, 0);
  const VectorXcd quarter = Complex(0, 1) * record.needed.force;
  const ScalarFit fit = scalar_fit({record.needed}, {{quarter}});
  EXPECT_NEAR(fit.coefficients[0], 0, kRounding);
  EXPECT_NEAR(fit.misfit, scalar_sums(record.needed, {}).total, kRounding);
}

TEST(ScalarFit, ColumnsOfVerySmallUnitsAreFoundAsWell) {
  constexpr double kLarge = 3e8, kSmall = 2e-7;
  Random random(7);
  AnyRecord record(random, 2);
  record.columns[0] *= 1 / kLarge;
  record.columns[1] *= 1 / kSmall;
  record.needed.force = kLarge * record.columns[0] - 4 * kSmall * record.columns[1];
  const ScalarFit fit = scalar_fit({record.needed}, {record.columns});
  EXPECT_NEAR(fit.coefficients[0] / kLarge, 1, kRounding);
  EXPECT_NEAR(fit.coefficients[1] / kSmall, -4, kRounding);
}

TEST(ScalarFit, ColumnsThatAreAlikeShareTheForce) {
  Random random(8);
  AnyRecord record(random, 1);
  record.columns.push_back(record.columns[0]);
  record.columns.push_back(VectorXcd::Zero(kBins));
  record.needed.force = 6 * record.columns[0];
  const ScalarFit fit = scalar_fit({record.needed}, {record.columns});
  ASSERT_TRUE(fit.coefficients.allFinite());
  EXPECT_NEAR(fit.coefficients[0] + fit.coefficients[1], 6, 1e-6);
  EXPECT_NEAR(fit.misfit / scalar_sums(record.needed, {}).total, 0, kRounding);
}

TEST(ScalarFit, SumsOfRecordsAddUp) {
  Random random(9);
  const AnyRecord one(random, 2), two(random, 2);
  const ScalarSums a = scalar_sums(one.needed, one.columns),
                   b = scalar_sums(two.needed, two.columns);
  ScalarSums both = a;
  both += b;
  EXPECT_LT((both.normal - a.normal - b.normal).norm(), kRounding);
  EXPECT_LT((both.right - a.right - b.right).norm(), kRounding);
  EXPECT_DOUBLE_EQ(both.total, a.total + b.total);
  EXPECT_LE(a.fit().misfit + b.fit().misfit, both.fit().misfit + kRounding);
}

TEST(LawParameter, HoldsItsValueAndBoundsInItsOwnUnits) {
  const LawParameter linear = linear_parameter(-3, -0.5);
  EXPECT_DOUBLE_EQ(linear.plain(), -3);
  EXPECT_DOUBLE_EQ(linear.step, 0.5);
  EXPECT_GT(linear_parameter(1, 0).step, 0);
  const LawParameter logarithmic = logarithmic_parameter(0.02, 1e-3, 4);
  EXPECT_NEAR(logarithmic.plain(), 0.02, 1e-15);
  EXPECT_NEAR(std::exp(logarithmic.low), 1e-3, 1e-15);
  EXPECT_NEAR(std::exp(logarithmic.high), 4, 1e-12);
  const LawParameter fixed = bounded_parameter(2, 0.1, 1, 3, false);
  EXPECT_FALSE(fixed.free);
  EXPECT_DOUBLE_EQ(fixed.low, 1);
  EXPECT_DOUBLE_EQ(fixed.high, 3);
}

}  // namespace scalar_fit_test
}  // namespace framewatch::estimator
