// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

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

}  // namespace hysteretic_force_test
}  // namespace framewatch::estimator
