// SPDX-License-Identifier: MIT
#include "estimator/diagnose/verdict/place_force.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "estimator/numeric/solve.h"
#include "tests/estimator/diagnose/exact_record.h"
#include "tests/estimator/diagnose/other_buildings.h"

namespace framewatch::estimator {
namespace place_force_test {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::Small;

constexpr int kFrame = 0;
constexpr double kCubic = 2e10;  // N/m^3: a third of the linear force at the largest deformation
constexpr std::uint64_t kSeed = 1;

struct Case {
  Small small;
  test::EffectTwins twins = test::cubic_spring(kFrame, kCubic);
  Plant plant = small.plant();
  Model linear = test::true_model(small, plant);
  Model with = test::with_effects(linear, {twins.modelled});

  RecordSegment segment(const MatrixXd& record) const { return small.segments({record}).front(); }
  RecordSegment noisy() const { return segment(small.record({twins.simulated}, kSeed)); }
  RecordSegment exact() const {
    return segment(test::exact_record(small, {twins.simulated}, kSeed));
  }
  PlaceForce force(const RecordSegment& s, const Model& before, const Model& after) const {
    const auto out = force_at(plant, before, after, s, 0, test::frame_place(kFrame));
    EXPECT_TRUE(out.has_value());
    return out.value_or(PlaceForce{});
  }
};

double rms(const VectorXd& v) {
  return std::sqrt(v.squaredNorm() / static_cast<double>(v.size()));
}

/// Stiffness, damping and cubic stiffness of a curve by least squares, and the rms of the rest.
struct FittedCurve {
  double k, c, k3, rest_n;
};

FittedCurve fitted(const ForceCurve& curve) {
  const Index n = curve.d_m.size() - 2;
  const VectorXd d = curve.d_m.segment(1, n);
  MatrixXd columns(n, 3);
  columns.col(0) = d;
  columns.col(1) = (curve.d_m.tail(n) - curve.d_m.head(n)) * test::kRate_hz / 2;
  columns.col(2) = d.array().cube();
  const VectorXd scale = columns.colwise().norm().cwiseInverse();
  const MatrixXd scaled = columns * scale.asDiagonal();
  const VectorXd force = curve.force_n.segment(1, n);
  const VectorXd x =
      Ldlt(MatrixXd(scaled.transpose() * scaled)).solve(VectorXd(scaled.transpose() * force));
  const VectorXd values = scale.cwiseProduct(x);
  return {values[0], values[1], values[2], rms(force - columns * values)};
}

TEST(PlaceForce, MeasuresTheLawThatActs) {
  constexpr double kOff = 0.03, kCubicOff = 0.1;
  const Case c;
  const PlaceForce f = c.force(c.noisy(), c.linear, c.with);
  ASSERT_TRUE(f.measured);
  EXPECT_TRUE(f.has_law);
  EXPECT_FALSE(f.of_direction);
  const FittedCurve curve = fitted(f.measurement);
  const double k = c.small.truth[c.small.table.frame_stiffness(1, kFrame)];
  EXPECT_NEAR(curve.k / k, 1, kOff);
  EXPECT_NEAR(curve.k3 / kCubic, 1, kCubicOff);
  // The band cuts off the third harmonic of the law, so the rest is not noise alone.
  EXPECT_LT(curve.rest_n, 0.03 * f.measured_n);
  const double cubic = kCubic * std::pow(f.peak_d_m, 3);
  EXPECT_GT(cubic, 0.1 * f.measured_n) << "the law must be seen";
}

TEST(PlaceForce, DoesNotDependOnTheModelOfItsOwnElement) {
  constexpr double kSame = 1e-9, kChange = 0.7;
  const Case c;
  const RecordSegment s = c.noisy();
  const PlaceForce with = c.force(s, c.linear, c.with);
  Model other = c.linear;  // another stiffness, and no law
  other.theta[c.small.table.frame_stiffness(1, kFrame)] *= kChange;
  const PlaceForce without = c.force(s, other, other);
  ASSERT_EQ(with.measurement.force_n.size(), without.measurement.force_n.size());
  EXPECT_LT(rms(with.measurement.force_n - without.measurement.force_n), kSame * with.measured_n);
  EXPECT_FALSE(without.has_law);
  EXPECT_EQ(without.with_effects.d_m.size(), 0);
  // Panels give a part of the force to other frames, by the model.
  EXPECT_GT(with.modelled_share, 0.01);
  EXPECT_LT(with.modelled_share, 0.9);
}

TEST(PlaceForce, GivesTheNoiseOfTheMeasuredForce) {
  constexpr double kOff = 0.3;
  const Case c;
  const PlaceForce noisy = c.force(c.noisy(), c.linear, c.linear),
                   exact = c.force(c.exact(), c.linear, c.linear);
  // Noise may move the largest deformation, and with it the samples that are shown.
  const auto first = [](const PlaceForce& f) {
    return static_cast<Index>(std::lround(f.from_s * test::kRate_hz));
  };
  const Index from = std::max(first(noisy), first(exact));
  const Index size = std::min(first(noisy) + noisy.measurement.force_n.size(),
                              first(exact) + exact.measurement.force_n.size()) -
                     from;
  ASSERT_GT(size, 30);
  const auto shared = [&](const PlaceForce& f) {
    return VectorXd(f.measurement.force_n.segment(from - first(f), size));
  };
  const double noise = rms(shared(noisy) - shared(exact));
  EXPECT_NEAR(noise / noisy.noise_n, 1, kOff);
}

TEST(PlaceForce, SimulationsComeNearWithTheLawOnly) {
  const Case c;
  const PlaceForce f = c.force(c.noisy(), c.linear, c.with);
  const double noise = f.noise_n / f.measured_rms_n;
  EXPECT_GT(f.linear_off, 0.1);
  EXPECT_LT(f.with_effects_off, 2 * noise + 0.02);
  EXPECT_NEAR(f.with_effects_n / f.measured_n, 1, 0.05);
  EXPECT_GT(f.to_s, f.from_s);
  EXPECT_LE(f.to_s, test::kSeconds);
  // The linear model's force is its stiffness times its deformation, and a little damping.
  const FittedCurve line = fitted(f.linear);
  EXPECT_NEAR(line.k / c.linear.theta[c.small.table.frame_stiffness(1, kFrame)], 1, 0.01);
  EXPECT_LT(std::abs(line.k3), 0.02 * kCubic);
}

TEST(PlaceForce, RigidFloorsShareTheInertiaOfADirection) {
  constexpr double kOff = 0.05;
  const Small small = test::rigid_small();
  const Plant plant = small.plant();
  const Model model = test::true_model(small, plant);
  const RecordSegment s = small.segments({small.record({}, kSeed)}).front();
  const auto f = force_at(plant, model, model, s, 0, test::frame_place(kFrame));
  ASSERT_TRUE(f && f->measured);
  EXPECT_TRUE(f->of_direction);
  EXPECT_NEAR(fitted(f->measurement).k / small.truth[small.table.frame_stiffness(1, kFrame)], 1,
              kOff);
}

TEST(PlaceForce, SumsTheInertiaOfAllFloorsAbove) {
  constexpr double kOff = 0.05;
  const Small small = test::tower(3);
  const Plant plant = small.plant();
  const Model model = test::true_model(small, plant);
  const RecordSegment s = small.segments({small.record({}, kSeed)}).front();
  for (int story = 1; story <= 3; ++story) {
    const auto f = force_at(plant, model, model, s, 0, test::frame_place(kFrame, story));
    ASSERT_TRUE(f && f->measured) << story;
    EXPECT_NEAR(fitted(f->measurement).k / small.truth[small.table.frame_stiffness(story, kFrame)],
                1, kOff)
        << story;
  }
}

TEST(PlaceForce, IsOfModelsAloneWhereNoSensorReads) {
  Small small = test::tower(3);
  std::erase_if(small.axes, [](const SensorAxis& a) { return a.story == 2; });
  const Plant plant = small.plant();
  const Model model = test::true_model(small, plant);
  const RecordSegment s = small.segments({small.record({}, kSeed)}).front();
  const auto f = force_at(plant, model, model, s, 0, test::frame_place(kFrame, 1));
  ASSERT_TRUE(f.has_value());
  EXPECT_FALSE(f->measured);
  EXPECT_EQ(f->measurement.d_m.size(), 0);
  EXPECT_GT(f->linear.d_m.size(), 0);
  EXPECT_GT(f->linear_n, 0);
}

TEST(PlaceForce, OfAWholeFrameIsThatOfItsHardestWorkedStory) {
  const Small small = test::tower(3);
  const Plant plant = small.plant();
  const Model model = test::true_model(small, plant);
  const RecordSegment s = small.segments({small.record({}, kSeed)}).front();
  EffectPlace whole = test::frame_place(kFrame, 0);
  whole.kind = PlaceKind::whole_frame;
  const auto f = force_at(plant, model, model, s, 0, whole);
  ASSERT_TRUE(f.has_value());
  EXPECT_EQ(f->place, test::frame_place(kFrame, 1)) << "equal stories: the lowest carries most";
}

TEST(PlaceForce, HasNoneAtAChannelOrAFloorWithoutLaw) {
  const Case c;
  const RecordSegment s = c.noisy();
  EXPECT_FALSE(force_at(c.plant, c.linear, c.linear, s, 0, test::channel_place(1)));
  EXPECT_FALSE(force_at(c.plant, c.linear, c.linear, s, 0, test::crossing_place(0)));
  EXPECT_FALSE(force_at(c.plant, c.linear, c.linear, s, 0, test::node_place(0)));
}

}  // namespace place_force_test
}  // namespace framewatch::estimator
