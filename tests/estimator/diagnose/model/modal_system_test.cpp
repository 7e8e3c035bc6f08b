// SPDX-License-Identifier: MIT
#include "estimator/diagnose/model/modal_system.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "estimator/numeric/eigenvalues.h"
#include "estimator/numeric/solve.h"
#include "estimator/simulate/random.h"

namespace framewatch::estimator {
namespace modal_system_test {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kRounding = 1e-9;

MatrixXd one(double x) {
  return MatrixXd::Constant(1, 1, x);
}

/// Three masses on a chain of springs, driven at two of them.
struct Chain {
  MatrixXd mass = MatrixXd(Eigen::Vector3d(2, 1, 3).asDiagonal());
  MatrixXd damping, stiffness, inputs = MatrixXd::Zero(3, 2);

  explicit Chain(double damping_factor) {
    stiffness.resize(3, 3);
    stiffness << 500, -200, 0, -200, 350, -150, 0, -150, 150;
    // Not proportional: the modes are complex.
    damping = damping_factor * MatrixXd(Eigen::Vector3d(1, 3, 0.5).asDiagonal());
    inputs(0, 0) = 1;
    inputs(2, 1) = -2;
    inputs(1, 1) = 0.5;
  }

  ModalSystem system(double step_s) const {
    return ModalSystem(mass, damping, stiffness, inputs, step_s);
  }

  /// Returns the matrix from displacements, velocities, inputs and their rates before a step to
  /// those after it.
  MatrixXd step_matrix(double step_s) const {
    MatrixXd a = MatrixXd::Zero(10, 10);
    const MatrixXd per_mass = inverse(mass);
    a.block(0, 3, 3, 3).setIdentity();
    a.block(3, 0, 3, 3) = -per_mass * stiffness;
    a.block(3, 3, 3, 3) = -per_mass * damping;
    a.block(3, 6, 3, 2) = per_mass * inputs;
    a.block(6, 8, 2, 2).setIdentity();
    return matrix_exponential(step_s * a);
  }
};

TEST(ModalSystem, MatchesTheClosedFormForARamp) {
  constexpr double kMass = 4, kHz = 1.5, kDamping = 0.05, kSeconds = 3;
  const double w = 2 * M_PI * kHz, stiffness = kMass * w * w,
               turn = w * std::sqrt(1 - kDamping * kDamping);
  for (const double step_s : {0.001, 0.05, 0.5}) {
    ModalSystem system(one(kMass), one(2 * kDamping * w * kMass), one(stiffness), one(1), step_s);
    ASSERT_TRUE(system.good());
    const ModalSystem::Observer seen = system.observe(VectorXd::Ones(1));
    const int steps = static_cast<int>(std::lround(kSeconds / step_s));
    for (int i = 0; i <= steps; ++i) system.predict(one(step_s * i));
    const double decay = std::exp(-kDamping * w * kSeconds), phase = turn * kSeconds;
    const double ringing = decay * (2 * kDamping / w * std::cos(phase) +
                                    (2 * kDamping * kDamping - 1) / turn * std::sin(phase));
    EXPECT_NEAR(system.displacement(seen) * stiffness, kSeconds - 2 * kDamping / w + ringing,
                kRounding)
        << step_s;
  }
}

TEST(ModalSystem, IsExactForInputsLinearWithinAStep) {
  constexpr int kSteps = 40;
  // Light damping, strong damping with overdamped modes, and almost none; steps from fine to longer
  // than a period.
  for (const double damping : {0.8, 40.0, 1e-3})
    for (const double step_s : {0.01, 0.2, 1.0}) {
      const Chain chain(damping);
      ModalSystem system = chain.system(step_s);
      ASSERT_TRUE(system.good());
      const MatrixXd step = chain.step_matrix(step_s);
      VectorXd state = VectorXd::Zero(10);
      Random random(5);
      system.predict(VectorXd::Zero(2));
      for (int i = 0; i < kSteps; ++i) {
        const VectorXd next = Eigen::Vector2d(random.normal(), random.normal());
        state.tail(2) = (next - state.segment(6, 2)) / step_s;
        state = (step * state).eval();
        system.predict(next);
      }
      for (int c = 0; c < 3; ++c) {
        const ModalSystem::Observer seen = system.observe(VectorXd::Unit(3, c));
        EXPECT_NEAR(system.displacement(seen), state[c], kRounding) << damping << " " << step_s;
        EXPECT_NEAR(system.velocity(seen), state[3 + c], kRounding * 100)
            << damping << " " << step_s;
      }
    }
}

TEST(ModalSystem, ACorrectedStepEqualsAFullStep) {
  const Chain chain(0.8);
  ModalSystem parts = chain.system(0.1), whole = chain.system(0.1);
  const ModalSystem::Observer seen = parts.observe(Eigen::Vector3d(1, -1, 0.3));
  Random random(6);
  for (int i = 0; i < 20; ++i) {
    const VectorXd input = Eigen::Vector2d(random.normal(), random.normal());
    const VectorXd first = Eigen::Vector2d(input[0], 0), second = Eigen::Vector2d(0, input[1]);
    whole.predict(input);
    parts.predict(first);
    const double d = parts.displacement(seen), v = parts.velocity(seen);
    parts.correct(second);
    EXPECT_NEAR(parts.displacement(seen), whole.displacement(seen), kRounding);
    // The observer's gain of an input at the end of the step.
    EXPECT_NEAR(parts.displacement(seen) - d, seen.displacement_gain * second, kRounding);
    EXPECT_NEAR(parts.velocity(seen) - v, seen.velocity_gain * second, kRounding);
  }
}

TEST(ModalSystem, AnAddedInputActsLikeAnInitialOne) {
  const Chain chain(0.8);
  Chain less = chain;
  less.inputs = chain.inputs.leftCols(1);
  ModalSystem whole = chain.system(0.1), added = less.system(0.1);
  EXPECT_EQ(added.add_input(inverse(chain.mass) * chain.inputs.col(1)), 1);
  const ModalSystem::Observer seen = added.observe(Eigen::Vector3d(1, -1, 0.3));
  Random random(7);
  for (int i = 0; i < 20; ++i) {
    const VectorXd input = Eigen::Vector2d(random.normal(), random.normal());
    whole.predict(input);
    added.predict(input);
    EXPECT_NEAR(added.displacement(seen), whole.displacement(seen), kRounding);
    EXPECT_NEAR(added.velocity(seen), whole.velocity(seen), kRounding);
  }
}

TEST(ModalSystem, RestsUntilItIsPushedAndAgainAfterReset) {
  const Chain chain(0.8);
  ModalSystem system = chain.system(0.1);
  const ModalSystem::Observer seen = system.observe(VectorXd::Unit(3, 2));
  for (int i = 0; i < 5; ++i) system.predict(VectorXd::Zero(2));
  EXPECT_EQ(system.displacement(seen), 0);
  system.predict(VectorXd::Ones(2));
  const double first = system.displacement(seen);
  EXPECT_NE(first, 0);
  system.reset();
  EXPECT_EQ(system.displacement(seen), 0);
  EXPECT_EQ(system.velocity(seen), 0);
  system.predict(VectorXd::Ones(2));
  EXPECT_DOUBLE_EQ(system.displacement(seen), first);
}

TEST(ModalSystem, AConstantForceEndsAtItsStaticDeformation) {
  const Chain chain(2.0);
  ModalSystem system = chain.system(0.5);
  for (int i = 0; i < 2000; ++i) system.predict(VectorXd::Unit(2, 1));
  const VectorXd expected = inverse(chain.stiffness) * chain.inputs.col(1);
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(system.displacement(system.observe(VectorXd::Unit(3, c))), expected[c], kRounding);
}

TEST(ModalSystem, IsNotGoodIfItDivergesOrIsNan) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  struct Case {
    double mass, damping, stiffness;
    bool good;
  };
  for (const Case& c : {Case{1, 0.1, 100, true}, Case{1, 0, 100, true}, Case{1, -5, 100, false},
                        Case{1, 0.1, -100, false}, Case{1, kNan, 100, false},
                        Case{kNan, 0.1, 100, false}, Case{0, 0.1, 100, false}})
    EXPECT_EQ(ModalSystem(one(c.mass), one(c.damping), one(c.stiffness), one(1), 0.1).good(),
              c.good)
        << c.mass << " " << c.damping << " " << c.stiffness;
}

}  // namespace modal_system_test
}  // namespace framewatch::estimator
