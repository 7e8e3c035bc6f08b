// SPDX-License-Identifier: MIT
// Peak drifts and their errors: against closed forms, with interruptions, and without a stiffness.
// drift_coverage_test.cpp tests how often the intervals hold.
#include "estimator/shaking/story_drift.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "estimator/simulate/random.h"

namespace framewatch::estimator {
namespace story_drift_test {

constexpr double kRate_hz = 100, kNoise = 1e-4;
constexpr double kMass_kg = 1000;

/// A story of one frame on a base.
PipelineConfig one_story() {
  PipelineConfig c;
  c.structure.stories = 1;
  c.structure.frames_x = {"y1"};
  c.structure.story_height = {3};
  c.structure.node_mass = {kMass_kg};
  c.options.rate_hz = kRate_hz;
  for (int story = 0; story <= 1; ++story) {
    SensorAxis axis;
    axis.story = story;
    axis.frame = story > 0 ? 0 : -1;
    axis.noise_density = kNoise;
    c.axes.push_back(axis);
  }
  return c;
}

WindowEstimate identified(double stiffness) {
  WindowEstimate e(2);
  e.status = WindowStatus::valid;
  e.value = {stiffness, 1e-3 * stiffness};
  e.std_error = {0.01 * stiffness, 1e-4 * stiffness};
  e.reason = {Observability::observable, Observability::observable};
  e.residual_ratio = 0.01;
  return e;
}

constexpr double kNatural_hz = 0.45;
double stiffness() {
  return kMass_kg * std::pow(2 * std::numbers::pi * kNatural_hz, 2);
}

struct Peak {
  PeakResponse peak{2, 1};
  DriftKnowledge known;
};

/// The story swings freely at kNatural_hz after 20 s of rest. Its drift is amplitude times a sine
/// that grows within a second; the floor's absolute acceleration is -w^2 of it (no damping).
Peak swing(double amplitude_m, bool with_stiffness, int gap_from = -1, int gap_to = -1,
           bool skipped = false) {
  Peak out;
  StoryResponse response(one_story());
  if (with_stiffness) response.follow(identified(stiffness()));
  const double w = 2 * std::numbers::pi * kNatural_hz;
  for (int i = 0; i < 4000; ++i) {
    if (skipped && i >= gap_from && i < gap_to) continue;
    const double t = i / kRate_hz - 20;
    const double growth = t < 0 ? 0 : t < 5 ? t / 5 : std::max(0.0, 1 - (t - 5) / 10);
    const double accel = -w * w * amplitude_m * growth * std::sin(w * t);
    const bool lost = !skipped && i >= gap_from && i < gap_to;
    // The ground moves so that the floor's acceleration matches a drift that obeys the spring.
    const double drift_accel = accel;
    response.push({from_microseconds(10'000LL * i), i, {accel - drift_accel, lost ? kNaN : accel}});
    out.peak.take(response);
  }
  out.known = response.knowledge();
  return out;
}

TEST(StoryDrift, SlowDriftIsRestoredFromTheStiffness) {
  constexpr double kAmplitude_m = 0.01, kLimit = 0.03, kLost = 0.02;
  const Peak with = swing(kAmplitude_m, true), without = swing(kAmplitude_m, false);
  const StoryDrift known = story_drifts(one_story(), with.peak, with.known)[0];
  const StoryDrift unknown = story_drifts(one_story(), without.peak, without.known)[0];
  EXPECT_NEAR(known.ratio * 3 / kAmplitude_m, 1, kLimit);
  EXPECT_TRUE(std::isfinite(known.slow_ratio));
  EXPECT_GT(std::abs(unknown.ratio - known.ratio) / known.ratio, kLost);
  EXPECT_TRUE(std::isnan(unknown.slow_ratio));
  EXPECT_TRUE(std::isnan(unknown.std_error)) << "the missing part is unknown without a stiffness";
}

TEST(StoryDrift, UnrestoredDriftCountsOnceTheStiffnessIsKnown) {
  Peak late = swing(0.01, false);
  late.known.theta = {stiffness(), kNaN};
  late.known.std_error = {0.01, kNaN};
  const StoryDrift d = story_drifts(one_story(), late.peak, late.known)[0];
  EXPECT_GT(d.slow_error / d.ratio, 0.1);
  EXPECT_NEAR(d.std_error, std::hypot(d.noise_error, d.slow_error), 1e-15);
}

TEST(StoryDrift, NoiseErrorContainsOnlyNoise) {
  constexpr double kLimit = 0.15;  // of a standard deviation over 500 s
  StoryResponse response(one_story());
  Random random(5);
  double squares = 0, count = 0;
  const double sigma = kNoise * std::sqrt(kRate_hz / 2);
  for (int i = 0; i < 60000; ++i) {
    response.push(
        {from_microseconds(10'000LL * i), i, {sigma * random.normal(), sigma * random.normal()}});
    if (i < 10000) continue;
    squares += std::pow(response.drift_m()[0], 2);
    ++count;
  }
  const Peak p = swing(0.01, true);
  const StoryDrift d = story_drifts(one_story(), p.peak, p.known)[0];
  EXPECT_NEAR(d.noise_error * 3 / std::sqrt(squares / count), 1, kLimit);
  DriftKnowledge measured = p.known;
  measured.noise_density = {2 * kNoise, 2 * kNoise};
  EXPECT_NEAR(story_drifts(one_story(), p.peak, measured)[0].noise_error, 2 * d.noise_error, 1e-12);
}

TEST(StoryDrift, AGapAtThePeakIsNoticed) {
  const Peak whole = swing(0.01, true);
  EXPECT_FALSE(story_drifts(one_story(), whole.peak, whole.known)[0].interrupted_at_peak());
  const Peak lost = swing(0.01, true, 2400, 2410);
  EXPECT_TRUE(story_drifts(one_story(), lost.peak, lost.known)[0].interrupted_at_peak());
  const Peak skipped = swing(0.01, true, 2450, 3300, true);
  EXPECT_TRUE(story_drifts(one_story(), skipped.peak, skipped.known)[0].interrupted_at_peak());
  const Peak early = swing(0.01, true, 500, 510);
  EXPECT_FALSE(story_drifts(one_story(), early.peak, early.known)[0].interrupted_at_peak());
}

TEST(StoryDrift, IsUnknownForADeadSensor) {
  const Peak dead = swing(0.01, true, 0, 4000);
  const StoryDrift d = story_drifts(one_story(), dead.peak, dead.known)[0];
  EXPECT_FALSE(d.known());
  EXPECT_TRUE(std::isnan(d.std_error));
}

TEST(StoryDrift, HasNoErrorIfTheSlowPartIsMissing) {
  PeakResponse bare;
  bare.accel_mps2 = {1, 1};
  bare.drift_m = {0.03};
  const StoryDrift d = story_drifts(one_story(), bare, {})[0];
  EXPECT_NEAR(d.ratio, 0.01, 1e-15);
  EXPECT_TRUE(std::isnan(d.std_error));
  EXPECT_FALSE(d.interrupted_at_peak());
}

}  // namespace story_drift_test
}  // namespace framewatch::estimator
