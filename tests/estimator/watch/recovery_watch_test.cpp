// SPDX-License-Identifier: MIT
// The recovery watch from instants and windows to renewals of a finding.
#include "estimator/watch/recovery_watch.h"

#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "estimator/simulate/random.h"
#include "estimator/state/archive.h"

namespace framewatch::estimator {
namespace recovery_watch_test {

constexpr double kRate_hz = 20, kWindow_s = 5, kValue = 5e9, kWeak_m = 1e-4;

Time at(double s) {
  return from_microseconds(std::llround(1e6 * s));
}

/// One story of one frame, with sensors on base and floor.
class RecoveryWatchTest : public testing::Test {
 protected:
  RecoveryWatchTest() {
    structure_.stories = 1;
    structure_.frames_x = {"y1"};
    structure_.story_height = {3};
    structure_.node_mass = {40};
    for (int story = 0; story <= 1; ++story) {
      SensorAxis axis;
      axis.story = story;
      axis.frame = story > 0 ? 0 : -1;
      axes_.push_back(axis);
    }
    Baseline baseline(2);
    baseline.value[0] = kValue;
    baseline.std_error[0] = 0.002 * kValue;
    for (int i = 0; i < 12; ++i) {
      const double a = kWeak_m * std::pow(2, i);
      baseline.by_amplitude[0].push_back({a, kValue * intact(a), 0.002 * kValue});
    }
    const ParameterTable table(structure_);
    watch_.emplace(table, options_, std::vector<double>{kWindow_s}, baseline);
    strong_.emplace(axes_, kRate_hz);
    recovery_.emplace(*watch_, options_);
  }
  static double intact(double a) { return 1 - 0.02 * std::log(a / kWeak_m); }
  /// Strong from `from_s` for 10 s, with a peak.
  void shake(double from_s, double peak_mps2) {
    for (double t = from_s; t < from_s + 10; t += 1 / kRate_hz)
      strong_->push({at(t), std::llround(t * kRate_hz), {0.2 + peak_mps2 * std::sin(6 * t), 0.1}});
  }
  /// Pushes windows of calm and returns the times of renewals.
  std::vector<double> watch(double from_s, double to_s, const std::function<double(double)>& loss,
                            double every_s = kWindow_s) {
    std::vector<double> renewed;
    for (double t = from_s; t < to_s; t += every_s) {
      WindowEstimate e(2);
      e.start = at(t);
      e.end = at(t + kWindow_s);
      e.status = WindowStatus::valid;
      const double a = 2 * kWeak_m;
      e.amplitude = {a, NAN};
      e.value = {kValue * intact(a) * (1 - loss(t)) * (1 + 0.005 * random_.normal()), NAN};
      e.std_error = {0.005 * kValue, NAN};
      e.prior_share = e.noise_share = {0, 0};
      e.reason = {Observability::observable, Observability::quiet};
      strong_->push({e.start, std::llround(t * kRate_hz), {0.2, 0.1}});
      recovery_->push(e, false, *watch_, *strong_);
      for (const int p : recovery_->due()) {
        EXPECT_EQ(p, 0);
        renewed.push_back(t + kWindow_s);
      }
    }
    return renewed;
  }

  Structure structure_;
  std::vector<SensorAxis> axes_;
  WatchOptions options_;
  std::optional<Watch> watch_;
  std::optional<StrongMotion> strong_;
  std::optional<RecoveryWatch> recovery_;
  Random random_{11};
};

double none(double) {
  return 0;
}
double lasting(double) {
  return 0.08;
}

TEST_F(RecoveryWatchTest, ReportsNothingWithoutStrongMotion) {
  EXPECT_TRUE(watch(0, 5000, none).empty());
  EXPECT_EQ(recovery_->of(0), nullptr);
}

TEST_F(RecoveryWatchTest, TheFindingIsRenewedThreeTimes) {
  (void)watch(0, 100, none);
  shake(100, 1);
  const std::vector<double> renewed = watch(110, 90'000, lasting, 50);
  ASSERT_EQ(renewed.size(), 3u);
  EXPECT_NEAR(renewed[0], 110 + 600, 60);
  EXPECT_NEAR(renewed[1], 110 + 3600, 60);
  EXPECT_NEAR(renewed[2], 110 + 86'400, 60);
  ASSERT_NE(recovery_->of(0), nullptr);
  EXPECT_EQ(recovery_->of(1), nullptr);  // not watched
  const RecoveryLaw law = recovery_->of(0)->law();
  EXPECT_EQ(law.verdict, RecoveryVerdict::lasting);
  EXPECT_NEAR(law.loss, 0.08, 4 * law.std_error);
}

TEST_F(RecoveryWatchTest, AnIntactFrameHasLostNothing) {
  shake(100, 1);
  (void)watch(110, 1000, none);
  EXPECT_EQ(recovery_->of(0)->law().verdict, RecoveryVerdict::recovered);
}

TEST_F(RecoveryWatchTest, RestartsOnlyAfterAnEquallyStrongAftershock) {
  shake(100, 1);
  (void)watch(110, 1000, lasting);
  const Time first = recovery_->of(0)->began();
  EXPECT_NEAR(1e-6 * static_cast<double>(to_microseconds(first)), 110, 0.5);
  shake(1000, 0.3);
  (void)watch(1010, 2000, lasting);
  EXPECT_EQ(recovery_->of(0)->began(), first);
  shake(2000, 0.8);
  (void)watch(2010, 3000, lasting);
  EXPECT_NEAR(1e-6 * static_cast<double>(to_microseconds(recovery_->of(0)->began())), 2010, 0.5);
}

TEST_F(RecoveryWatchTest, ContinuesFromItsState) {
  shake(100, 1);
  (void)watch(110, 500, lasting);
  StateWriter writer;
  writer(*strong_, *recovery_);
  StrongMotion strong(axes_, kRate_hz);
  RecoveryWatch again(*watch_, options_);
  StateReader reader(writer.bytes());
  reader(strong, again);
  ASSERT_TRUE(reader.whole());
  EXPECT_EQ(again.of(0)->law().loss, recovery_->of(0)->law().loss);
  EXPECT_EQ(strong.last(), strong_->last());
}

}  // namespace recovery_watch_test
}  // namespace framewatch::estimator
