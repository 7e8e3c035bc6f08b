// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "estimator/diagnose/law/hysteretic_force.h"
#include "estimator/diagnose/law/law.h"

namespace framewatch::estimator {
namespace hysteretic_force_test {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kParts = 16;

/// Divides every step of a motion into kParts.
VectorXd in_parts(const VectorXd& d) {
  VectorXd out(kParts * (d.size() - 1) + 1);
  for (Index i = 0; i < out.size(); ++i) {
    const Index at = std::min(i / kParts, d.size() - 2);
    const double part = static_cast<double>(i - kParts * at) / kParts;
    out[i] = (1 - part) * d[at] + part * d[at + 1];
  }
  return out;
}

TEST(Yielding, LargeStepsEndWhereSmallStepsDo) {
  constexpr double kMax = 5e-3;  // of the force
  VectorXd d(400);
  for (Index i = 0; i < d.size(); ++i) {
    const auto t = static_cast<double>(i);
    d[i] = 0.01 * (std::sin(0.1 * t) + 0.6 * std::sin(0.23 * t + 1));
  }
  const VectorXd fine = in_parts(d);
  for (const LawForm form : {LawForm::hysteresis, LawForm::pinched, LawForm::slip_lock})
    for (const double exponent : {0.6, 1.0, 3.0}) {
      std::vector<double> p{1, 2e-4, exponent, 0.5};
      if (form != LawForm::hysteresis) p.insert(p.end(), {0.85, 0.3, 0, 0});
      const LawValues law{form, p, 0.016, 1, 1};
      const VectorXd force = law_force(law, d, VectorXd::Zero(d.size()), 0.01);
      const VectorXd of_parts = law_force(law, fine, VectorXd::Zero(fine.size()), 0.01 / kParts);
      double most = 0;
      for (Index i = 0; i < d.size(); ++i)
        most = std::max(most, std::abs(force[i] - of_parts[kParts * i]) / p[1]);
      EXPECT_LT(most, kMax) << static_cast<int>(form) << " " << exponent;
    }
}

/// Returns z of a peak-oriented law along its deformations, in units of dy.
std::vector<double> peak_oriented_z(double unloading, const std::vector<double>& x) {
  PeakOriented law(unloading);
  std::vector<double> out;
  for (const double to : x) {
    out.push_back(law.at(to));
    law.move(to);
    EXPECT_NEAR(law.at(to), out.back(), 1e-12) << to;
  }
  return out;
}

void expect_z(const std::vector<double>& z, const std::vector<double>& expected) {
  ASSERT_EQ(z.size(), expected.size());
  for (std::size_t i = 0; i < z.size(); ++i) EXPECT_NEAR(z[i], expected[i], 1e-12) << i;
}

TEST(PeakOriented, ReturnsTowardTheLargestDeformation) {
  // Yields, unloads, yields on the other side at first, then goes back to 3.
  expect_z(peak_oriented_z(0, {0.5, 1, 3, 2.5, 2, 0.5, -1, -2, -1.5, -1, 1, 3, 4}),
           {0.5, 1, 1, 0.5, 0, -0.5, -1, -1, -0.5, 0, 0.5, 1, 1});
  // In one step as in several.
  expect_z(peak_oriented_z(0, {3, -2, 1, 4}), {1, -1, 0.5, 1});
}

TEST(PeakOriented, UnloadsWithLessStiffnessAfterALargerDeformation) {
  expect_z(peak_oriented_z(0.5, {4, 3, 2, 0.5, -1}), {1, 0.5, 0, -0.5, -1});
}

TEST(PeakOriented, ACycleThatDoesNotReachZeroReturnsOnItsLine) {
  expect_z(peak_oriented_z(0, {3, 2.5, 2.8, 2.6, 3, 3.5, 3}), {1, 0.5, 0.8, 0.6, 1, 1, 0.5});
  // It turns on the way to the largest deformation, goes back there, and on.
  expect_z(peak_oriented_z(0, {3, -1, -0.8, 1.5, 1.4, 1.5, 3}), {1, -1, -0.8, 0.5, 0.4, 0.5, 1});
  // A turn is forgotten where z changes its sign.
  expect_z(peak_oriented_z(0, {3, 2.5, -1, 0, 3}), {1, 0.5, -1, 0, 1});
}

TEST(PeakOriented, IsElasticBeforeItYields) {
  expect_z(peak_oriented_z(0.5, {0.9, -0.9, 0.2, 0.1, 0.9}), {0.9, -0.9, 0.2, 0.1, 0.9});
}

}  // namespace hysteretic_force_test
}  // namespace framewatch::estimator
