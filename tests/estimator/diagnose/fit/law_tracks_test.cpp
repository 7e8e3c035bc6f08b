// SPDX-License-Identifier: MIT
#include <cmath>
#include <complex>

#include <gtest/gtest.h>

#include "estimator/diagnose/fit/law_tracks.h"
#include "estimator/diagnose/fit/whitened.h"
#include "estimator/numeric/complex.h"
#include "tests/estimator/diagnose/exact_record.h"

namespace framewatch::estimator {
namespace law_tracks_test {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::VectorXcd;
using Eigen::VectorXd;
using test::effect_of;
using test::Small;

constexpr double kRounding = 1e-9;
constexpr int kRatio = 3;

VectorXd random_signal(Index size, std::uint64_t seed) {
  Random random(seed);
  VectorXd out(size);
  for (double& x : out) x = random.normal();
  return out;
}

TEST(EquivalentElement, EqualsALinearElement) {
  constexpr double kStiffness = 3e5, kDamping = -2e3;
  LawTrack track{random_signal(500, 1), random_signal(500, 2), {}};
  track.force = kStiffness * track.d + kDamping * track.v;
  const Equivalent linear = equivalent_of(track);
  EXPECT_NEAR(linear.stiffness, kStiffness, kRounding * kStiffness);
  EXPECT_NEAR(linear.damping, kDamping, kRounding * kStiffness);
}

TEST(EquivalentElement, MinimizesTheRemainingForce) {
  LawTrack track{random_signal(500, 1), random_signal(500, 2), {}};
  track.force = track.d.array().cube() + track.v.array().abs();
  const Equivalent linear = equivalent_of(track);
  const VectorXd rest = track.force - linear.stiffness * track.d - linear.damping * track.v;
  EXPECT_NEAR(rest.dot(track.d), 0, kRounding * track.force.norm() * track.d.norm());
  EXPECT_NEAR(rest.dot(track.v), 0, kRounding * track.force.norm() * track.v.norm());
}

TEST(EquivalentElement, DoesNotExistIfTheMotionIsInsufficient) {
  const VectorXd moves = random_signal(100, 1), rests = VectorXd::Zero(100);
  for (const auto& [d, v] : {std::pair(rests, rests), std::pair(moves, rests),
                             std::pair(rests, moves), std::pair(moves, VectorXd(-2 * moves))}) {
    const Equivalent linear = equivalent_of({d, v, moves});
    EXPECT_EQ(linear.stiffness, 0);
    EXPECT_EQ(linear.damping, 0);
  }
}

TEST(EquivalentElement, LeavesNothingOfALinearForce) {
  const VectorXd w = VectorXd::LinSpaced(20, 3, 30);
  const VectorXcd d = VectorXcd::Constant(20, Complex(2e-3, -1e-3));
  const Equivalent linear{4e5, 3e3};
  const VectorXcd force = d.array() * (linear.stiffness + kJ * linear.damping * w.array());
  EXPECT_LT(beyond(linear, force, d, w).norm(), kRounding * force.norm());
  EXPECT_EQ(beyond({}, force, d, w), force);
}

struct Measured {
  Small small;
  Plant plant = small.plant();
  RecordSegment segment = small.segments({small.record({}, 1)}).front();
  Model model = test::true_model(small, plant);
};

TEST(HarmonicBins, MatchTheirWaves) {
  constexpr Index kBin = 12;
  constexpr double kCosine = 300, kSine = -200;
  const Measured m;
  const double hz = m.segment.w[kBin] / (2 * M_PI);
  const ModelEffect force =
      effect_of(LawForm::harmonic, test::node_place(1), {hz}, {kCosine, kSine});
  VectorXcd expected = VectorXcd::Zero(m.segment.bins());
  expected[kBin] = 0.5 * static_cast<double>(m.segment.intervals()) * Complex(kCosine, -kSine);
  EXPECT_LT((harmonic_bins(force, m.segment, 0) - expected).norm(), 1e-6 * expected.norm());
}

TEST(HarmonicBins, BeginAtTheOnset) {
  const Measured m;
  ModelEffect force = effect_of(LawForm::harmonic, test::node_place(1), {3}, {300, 0});
  const VectorXcd all = harmonic_bins(force, m.segment, 0);
  force.onset_s = {0.5 * m.segment.seconds()};
  const VectorXcd half = harmonic_bins(force, m.segment, 0);
  EXPECT_GT(half.norm(), 0.3 * all.norm());
  EXPECT_LT(half.norm(), 0.9 * all.norm());
  force.onset_s = {m.segment.seconds() + 1};
  EXPECT_EQ(harmonic_bins(force, m.segment, 0).norm(), 0);
}

TEST(LawTracks, FollowTheGivenMotion) {
  constexpr Index kBin = 30;
  constexpr int kFrame = 1;
  constexpr double kAmplitude = 0.4, kStiffness = 2e5;  // m/s^2 of the frame's axis
  Measured m;
  m.segment.accel.setZero();  // nothing above the band either
  m.model.effects = {effect_of(LawForm::power, test::frame_place(kFrame), {kStiffness, 1})};
  MatrixXcd motion = MatrixXcd::Zero(6, m.segment.bins());
  motion(kFrame, kBin) = 0.5 * kAmplitude * static_cast<double>(m.segment.intervals());
  const auto tracks = tracks_of(m.plant, m.model, m.segment, 0, Forcing::measured, motion, kRatio);
  ASSERT_TRUE(tracks);
  ASSERT_EQ(tracks->size(), 1U);
  const LawTrack& track = tracks->front();
  ASSERT_EQ(track.d.size(), m.segment.intervals() * kRatio);
  const double w = m.segment.w[kBin];
  for (Index i = 0; i < track.d.size(); i += 17) {
    const double phase = w * static_cast<double>(i) / (m.segment.rate_hz * kRatio);
    ASSERT_NEAR(track.d[i], -kAmplitude / (w * w) * std::cos(phase), kRounding);
    ASSERT_NEAR(track.v[i], kAmplitude / w * std::sin(phase), kRounding);
    ASSERT_NEAR(track.force[i], kStiffness * track.d[i], kRounding * kStiffness);
  }
}

TEST(LawTracks, CoverOnlyLawsOfElements) {
  Measured m;
  const auto count = [&](Forcing forcing) {
    const auto tracks = tracks_of(m.plant, m.model, m.segment, 0, forcing, {}, kRatio);
    return tracks ? static_cast<int>(tracks->size()) : -1;
  };
  EXPECT_EQ(count(Forcing::measured), 0);
  m.model.effects = {test::extra_mass(1, 500).modelled, test::cubic_spring(0, 1e9).modelled,
                     effect_of(LawForm::friction, test::panel_place(0), {10, 1e-3})};
  EXPECT_EQ(count(Forcing::measured), 2);
  EXPECT_EQ(count(Forcing::simulated), 2);
  m.model.effects = {
      effect_of(LawForm::power, test::frame_place(0), {-5 * m.small.truth.maxCoeff(), 1})};
  EXPECT_EQ(count(Forcing::measured), 1);
  EXPECT_EQ(count(Forcing::simulated), -1);  // it diverges
}

}  // namespace law_tracks_test
}  // namespace framewatch::estimator
