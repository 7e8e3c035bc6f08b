// SPDX-License-Identifier: MIT
#include "estimator/simulate/linear_building.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "estimator/simulate/ground_motion.h"
#include "estimator/structure/matrices.h"
#include "tests/support/paper_buildings.h"

namespace framewatch::estimator {
namespace linear_building_test {

/// One story, one frame: mass 2 kg, stiffness k, damping c.
Structure one_mass() {
  Structure s;
  s.stories = 1;
  s.frames_x = {"y1"};
  s.story_height = {1.0};
  s.node_mass = {2.0};
  return s;
}

Eigen::VectorXd vector(std::initializer_list<double> values) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(values.size()));
  std::copy(values.begin(), values.end(), out.begin());
  return out;
}

double energy(const Matrices& m, const LinearBuilding& b) {
  const Eigen::VectorXd d = b.disp_rel();
  const Eigen::VectorXd v = b.vel_rel();
  return 0.5 * v.dot(m.mass.cwiseProduct(v)) + 0.5 * d.dot(m.stiffness * d);
}

TEST(LinearBuilding, FreeVibrationIsTheClosedForm) {
  const Structure s = one_mass();
  const double k = 800, c = 4, m = 2, d0 = 0.01;
  LinearBuilding b(s, ParameterTable(s), vector({k, c}), 0.013);
  b.set_state(vector({d0}), vector({0}));
  const double w = std::sqrt(k / m), zeta = c / (2 * m * w), wd = w * std::sqrt(1 - zeta * zeta);
  for (int i = 1; i <= 500; ++i) {
    b.advance({0, 0}, {0, 0});
    const double t = 0.013 * i;
    const double decay = d0 * std::exp(-zeta * w * t);
    const double d = decay * (std::cos(wd * t) + zeta * w / wd * std::sin(wd * t));
    const double v = -decay * w * w / wd * std::sin(wd * t);
    ASSERT_NEAR(b.disp_rel()[0], d, 1e-12 * d0);
    ASSERT_NEAR(b.accel_abs()[0], -(k * d + c * v) / m, 1e-10 * d0 * w * w);
  }
}

TEST(LinearBuilding, RampOfTheGroundIsTheClosedForm) {
  const Structure s = one_mass();
  const double k = 800, m = 2, h = 0.05, slope = 3;
  LinearBuilding b(s, ParameterTable(s), vector({k, 0}), h);
  const double w = std::sqrt(k / m);
  for (int i = 0; i < 40; ++i) {
    b.advance({slope * h * i, 0}, {slope * h * (i + 1), 0});
    const double t = h * (i + 1);
    ASSERT_NEAR(b.disp_rel()[0], -slope / (w * w) * (t - std::sin(w * t) / w), 1e-13);
  }
}

/// Integrates the assembled matrices independently: fourth-order Runge-Kutta in 0.1 ms steps.
TEST(LinearBuilding, AgreesWithRungeKutta) {
  const Structure s = test::table2();
  const ParameterTable table(s);
  const Eigen::VectorXd theta = test::table2_theta('c');
  const GroundMotion motion = kanai_tajimi({.duration_s = 3, .step_s = 0.01});
  const double phi = M_PI / 5;
  const Matrices m = assemble(s, table, theta);
  Eigen::VectorXd r(s.degrees_of_freedom());
  for (int story = 1; story <= s.stories; ++story)
    for (int f = 0; f < s.frames(); ++f)
      r[s.dof(story, f)] = s.direction(f) == Direction::x ? std::cos(phi) : std::sin(phi);

  const auto accel_abs = [&](const Eigen::VectorXd& d, const Eigen::VectorXd& v) {
    return Eigen::VectorXd(-(m.damping * v + m.stiffness * d).cwiseQuotient(m.mass));
  };
  const double h = 1e-4;
  Eigen::VectorXd d = Eigen::VectorXd::Zero(r.size()), v = d;
  LinearBuilding b(s, table, theta, 0.01);
  double worst = 0, largest = 0;
  for (int i = 0; i < 300; ++i) {
    for (int j = 0; j < 100; ++j) {
      const double t = 0.01 * i + h * j;
      const auto rate = [&](double at, const Eigen::VectorXd& dd, const Eigen::VectorXd& vv) {
        return Eigen::VectorXd(accel_abs(dd, vv) - r * motion.at(at));
      };
      const Eigen::VectorXd a1 = rate(t, d, v), v2 = v + h / 2 * a1;
      const Eigen::VectorXd a2 = rate(t + h / 2, d + h / 2 * v, v2), v3 = v + h / 2 * a2;
      const Eigen::VectorXd a3 = rate(t + h / 2, d + h / 2 * v2, v3), v4 = v + h * a3;
      const Eigen::VectorXd a4 = rate(t + h, d + h * v3, v4);
      d += h / 6 * (v + 2 * v2 + 2 * v3 + v4);
      v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    }
    const Eigen::Vector2d plan(std::cos(phi), std::sin(phi));
    b.advance(plan * motion.accel[static_cast<std::size_t>(i)],
              plan * motion.accel[static_cast<std::size_t>(i) + 1]);
    worst = std::max(worst, (b.accel_abs() - accel_abs(d, v)).lpNorm<Eigen::Infinity>());
    largest = std::max(largest, b.accel_abs().lpNorm<Eigen::Infinity>());
  }
  EXPECT_GT(largest, 0.5);
  EXPECT_LT(worst, 1e-8 * largest);
}

TEST(LinearBuilding, KeepsItsEnergyWithoutDamping) {
  const Structure s = test::table1();
  const ParameterTable table(s);
  Eigen::VectorXd theta = test::table1_theta();
  theta.tail(table.elements()).setZero();
  LinearBuilding b(s, table, theta, 0.01);
  const Matrices m = assemble(s, table, theta);
  Eigen::VectorXd d(s.degrees_of_freedom());
  for (Eigen::Index i = 0; i < d.size(); ++i) d[i] = 0.01 * std::cos(3.0 * static_cast<double>(i));
  b.set_state(d, Eigen::VectorXd::Zero(d.size()));
  const double before = energy(m, b);
  for (int i = 0; i < 5000; ++i) b.advance({0, 0}, {0, 0});
  EXPECT_NEAR(energy(m, b) / before, 1, 1e-10);
}

TEST(LinearBuilding, SettlesOnTheStaticDeflection) {
  const Structure s = test::table2();
  const ParameterTable table(s);
  Eigen::VectorXd theta = test::table2_theta('b');
  theta.tail(table.elements()) *= 20;
  LinearBuilding b(s, table, theta, 0.01);
  for (int i = 0; i < 6000; ++i) b.advance({0.7, 0}, {0.7, 0});
  const Matrices m = assemble(s, table, theta);
  Eigen::VectorXd force = Eigen::VectorXd::Zero(m.mass.size());
  for (int story = 1; story <= s.stories; ++story)
    for (int f = 0; f < s.n(); ++f) force[s.dof(story, f)] = -0.7 * m.mass[s.dof(story, f)];
  const Eigen::VectorXd deflection = m.stiffness.ldlt().solve(force);
  EXPECT_LT((b.disp_rel() - deflection).norm(), 1e-9 * deflection.norm());
  for (int story = 1; story <= s.stories; ++story)
    for (int f = 0; f < s.frames(); ++f)
      EXPECT_NEAR(b.accel_abs()[s.dof(story, f)], f < s.n() ? 0.7 : 0.0, 1e-9);
}

TEST(LinearBuilding, RigidFloorsMoveAsOneAndMatchVeryStiffPanels) {
  Structure flexible = test::table1();
  Structure rigid = flexible;
  rigid.floor = FloorModel::rigid;
  const ParameterTable flexible_table(flexible), rigid_table(rigid);
  Eigen::VectorXd theta = test::table1_theta();
  Eigen::VectorXd rigid_theta(rigid_table.size());
  for (int i = 0; i < rigid_table.size(); ++i)
    rigid_theta[i] = theta[*flexible_table.find(rigid_table[i].name)];
  for (int story = 1; story <= 5; ++story) {
    theta[flexible_table.panel_stiffness(story, 0)] = 1e12;
    theta[flexible_table.panel_damping(story, 0)] = 1e9;
  }
  LinearBuilding a(flexible, flexible_table, theta, 0.01);
  LinearBuilding b(rigid, rigid_table, rigid_theta, 0.01);
  double worst = 0, largest = 0, shear = 0;
  Eigen::Vector2d ground(0, 0);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector2d next(std::sin(0.05 * i), 0.5 * std::sin(0.031 * i));
    a.advance(ground, next);
    b.advance(ground, next);
    ground = next;
    worst = std::max(worst, (a.accel_abs() - b.accel_abs()).lpNorm<Eigen::Infinity>());
    largest = std::max(largest, b.accel_abs().lpNorm<Eigen::Infinity>());
    const auto top = b.accel_abs().tail<4>();
    shear = std::max(shear, std::abs((top[1] - top[0]) / 15.0 + (top[3] - top[2]) / 10.7));
  }
  EXPECT_GT(largest, 0.5);
  EXPECT_LT(worst, 1e-5 * largest);
  EXPECT_LT(shear, 1e-12 * largest);
}

TEST(LinearBuilding, AStiffBuildingFollowsTheGround) {
  const Structure s = test::table1();
  const ParameterTable table(s);
  LinearBuilding b(s, table, 1e8 * test::table1_theta(), 0.01);
  Eigen::Vector2d ground(0, 0);
  for (int i = 1; i < 500; ++i) {
    const Eigen::Vector2d next(1 - std::cos(0.02 * i), std::cos(0.02 * i) - 1);
    b.advance(ground, next);
    ground = next;
  }
  for (int f = 0; f < 4; ++f) EXPECT_NEAR(b.accel_abs()[s.dof(5, f)], ground[f < 2 ? 0 : 1], 1e-5);
}

TEST(LinearBuilding, ContinuesFromItsStateWhenAStiffnessChanges) {
  const Structure s = one_mass();
  LinearBuilding b(s, ParameterTable(s), vector({800, 0}), 0.01);
  b.set_state(vector({0.01}), vector({0.3}));
  b.set_theta(vector({200, 0}));
  EXPECT_NEAR(b.disp_rel()[0], 0.01, 1e-15);
  EXPECT_NEAR(b.vel_rel()[0], 0.3, 1e-15);
  EXPECT_NEAR(b.accel_abs()[0], -1.0, 1e-13);
  for (int i = 0; i < 20; ++i) b.advance({0, 0}, {0, 0});
  EXPECT_NEAR(b.disp_rel()[0], 0.01 * std::cos(2.0) + 0.03 * std::sin(2.0), 1e-13);
}

}  // namespace linear_building_test
}  // namespace framewatch::estimator
