// SPDX-License-Identifier: MIT
// Baselines that follow temperature and amplitude: what they learn and which changes are then
// found.
#include "estimator/watch/dependence.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "daemon/tools/lab/study_buildings.h"
#include "estimator/simulate/random.h"
#include "estimator/state/archive.h"
#include "estimator/watch/watch.h"

namespace framewatch::estimator {
namespace dependence_test {

constexpr double kHour_s = 3600;
constexpr double kError = 0.01;  // of a window's value
/// Issue 9: a daily swing of this, from trough to crest, raises no alarm.
constexpr double kSwing = 0.03;
constexpr double kCold_degc = -5, kWarm_degc = 15;
constexpr double kPerDegc = -kSwing / (kWarm_degc - kCold_degc);
constexpr double kPerLog = -0.01;
constexpr int kStrong = 4;  // windows of other lengths; the long one has this index

Time at(double hours) {
  return from_microseconds(std::llround(1e6 * kHour_s * hours));
}

double degc_at(double hours) {
  return (kCold_degc + kWarm_degc) / 2 +
         (kWarm_degc - kCold_degc) / 2 * std::sin(2 * M_PI * hours / 24);
}

/// Returns the long window of a parameter table that ends after so many hours.
WindowEstimate window(int parameters, double end_hours) {
  WindowEstimate e(static_cast<std::size_t>(parameters));
  e.window = kStrong;
  e.end = at(end_hours);
  e.start = at(end_hours - 1) + SensorClock::duration(10'000);
  e.status = WindowStatus::valid;
  std::fill(e.value.begin(), e.value.end(), 1.0);
  std::fill(e.std_error.begin(), e.std_error.end(), kError);
  std::fill(e.snr.begin(), e.snr.end(), 20.0);
  std::fill(e.prior_share.begin(), e.prior_share.end(), 0.0);
  std::fill(e.noise_share.begin(), e.noise_share.end(), 0.0);
  std::fill(e.reason.begin(), e.reason.end(), Observability::observable);
  return e;
}

TEST(DependenceLearner, FindsTheDependenceOfValues) {
  DependenceLearner learner(1, {240 * kHour_s, true, true});
  Random random(1);
  for (int h = 1; !learner.complete(); ++h) {
    WindowEstimate e = window(1, h);
    const double degc = degc_at(h), log = 0.5 * random.normal();
    e.snr[0] = std::exp(2 * log);
    e.value[0] = 5 * (1 + kPerDegc * degc + kPerLog * log + kError * random.normal());
    e.std_error[0] = 5 * kError;
    (void)learner.push(e, degc);
    ASSERT_LT(h, 300);
  }
  const Baseline baseline = learner.baseline();
  const Dependence dependence = learner.dependence();
  for (const double degc : {-10.0, 5.0, 20.0}) {
    for (const double log : {-1.0, 1.0}) {
      const Dependence::Expected now = dependence.expected(0, {degc, log});
      const double expected = 5 * (1 + kPerDegc * degc + kPerLog * log);
      const double error = std::hypot(baseline.std_error[0], 5 * now.std_error);
      EXPECT_NEAR(baseline.value[0] * now.ratio, expected, 4 * error);
      EXPECT_LT(now.std_error, 0.006);
    }
  }
}

TEST(DependenceLearner, GivesAnErrorForUnseenConditions) {
  DependenceLearner learner(1, {24 * kHour_s, true, false});
  for (int h = 1; !learner.complete(); ++h) (void)learner.push(window(1, h), 10);
  const Dependence dependence = learner.dependence();
  const Dependence::Expected same = dependence.expected(0, {10, 0}),
                             colder = dependence.expected(0, {0, 0}),
                             unknown = dependence.expected(0, {std::nan(""), 0});
  EXPECT_NEAR(same.std_error, 0, 1e-12);
  EXPECT_NEAR(colder.std_error, 10 * DependenceLearner::kUsualPerDegc, 1e-9);
  EXPECT_TRUE(std::isinf(unknown.std_error));
}

TEST(DependenceLearner, LeavesOutWindowsThatOverlapOrHaveNoTemperature) {
  DependenceLearner learner(1, {3 * kHour_s - 1, true, false});
  EXPECT_FALSE(learner.push(window(1, 1), std::nan("")));
  EXPECT_FALSE(learner.push(window(1, 2), 5));
  WindowEstimate overlapping = window(1, 2.5);
  overlapping.value[0] = 9;
  EXPECT_FALSE(learner.push(overlapping, 5));
  EXPECT_FALSE(learner.push(window(1, 3), 5));
  EXPECT_TRUE(learner.push(window(1, 4), 5));
  EXPECT_NEAR(learner.baseline().value[0], 1, 1e-12);
}

TEST(MeanTemperature, AveragesTheRequestedStretches) {
  MeanTemperature mean(180);
  for (int s = 0; s < 40'000; s += 60) mean.push(from_microseconds(1'000'000LL * s), s / 3600.0);
  mean.push(from_microseconds(1'000'000LL * 39'960), 1e9);  // broken
  EXPECT_NEAR(mean.mean(at(9), at(10) - SensorClock::duration(1)), 9.5, 0.02);
  EXPECT_NEAR(mean.mean(at(11.5), at(11.6)), 11.1, 0.05);  // still valid
  EXPECT_TRUE(std::isnan(mean.mean(at(1), at(2))));        // no longer valid
  EXPECT_TRUE(std::isnan(mean.mean(at(20), at(21))));
}

/// Sixty days of long windows of a building whose frames all follow the temperature. After forty
/// days one of them loses 5 %.
struct Months {
  int false_alarms = 0;
  double found_hours = std::numeric_limits<double>::infinity();
};
Months watch(bool follows_temperature) {
  constexpr int kLearn_hours = 72, kChange_hours = 40 * 24, kHours = 60 * 24;
  const ParameterTable table(daemon::table1());
  WatchOptions options;
  options.quiet_learn_hours = kLearn_hours;
  options.temperature = follows_temperature;
  Watch watch(table, options, {5, 1, 2.5, 10}, std::nullopt);
  Random random(2);
  Months out;
  for (int fifth = 5; fifth < 5 * kHours; ++fifth) {
    const double hours = fifth / 5.0;
    watch.temperature(at(hours), degc_at(hours));
    WindowEstimate e = window(table.size(), hours);
    const double swing = 1 + kPerDegc * degc_at(hours - 0.5);
    for (std::size_t p = 0; p < e.value.size(); ++p) {
      const bool lost = p == 0 && hours > kChange_hours;
      e.value[p] = swing * (lost ? 0.95 : 1.0) + kError * random.normal();
    }
    for (const Alarm& alarm : watch.push(e)) {
      if (alarm.state != AlarmState::raised) continue;
      if (alarm.parameter == 0 && hours > kChange_hours)
        out.found_hours = std::min(out.found_hours, hours - kChange_hours);
      else
        ++out.false_alarms;
    }
  }
  return out;
}

TEST(Watch, ADailySwingThatFollowsTemperatureIsNoChange) {
  constexpr double kSoon_hours = 6;
  const Months follows = watch(true), blind = watch(false);
  EXPECT_EQ(follows.false_alarms, 0);
  EXPECT_LT(follows.found_hours, kSoon_hours);
  // Without a thermometer, alarms come and go, or are missing only because the baseline's error
  // covers the swing.
  EXPECT_TRUE(blind.false_alarms > 0 || blind.found_hours > follows.found_hours);
}

/// Ordinary windows all day, with a thermometer that is slower than they are.
TEST(Watch, ADailySwingRaisesNothingInOrdinaryWindows) {
  constexpr int kLearn_hours = 24, kDays = 3, kWindow_s = 10, kThermometer_s = 290;
  const ParameterTable table(daemon::table1());
  WatchOptions options;
  options.quiet_learn_hours = kLearn_hours;
  options.temperature = true;
  Watch watch(table, options, {5, 1, 2.5, 10}, std::nullopt);
  Random random(3);
  int false_alarms = 0;
  for (int s = kWindow_s; s < kDays * 24 * kHour_s; s += kWindow_s) {
    const double hours = s / kHour_s;
    if (s / kThermometer_s != (s - kWindow_s) / kThermometer_s)
      watch.temperature(at(hours), degc_at(hours));
    WindowEstimate e = window(table.size(), hours);
    const bool whole_hour = s % static_cast<int>(kHour_s) == 0;
    const double middle = hours - (whole_hour ? 0.5 : 0);
    e.window = whole_hour ? kStrong : 0;
    if (!whole_hour) e.start = e.end - SensorClock::duration(1'000'000 * (kWindow_s - 1));
    for (double& value : e.value) value = 1 + kPerDegc * degc_at(middle) + kError * random.normal();
    for (const Alarm& alarm : watch.push(e))
      false_alarms += alarm.state == AlarmState::raised ? 1 : 0;
  }
  EXPECT_EQ(false_alarms, 0);
  EXPECT_NE(watch.quiet_baseline(), nullptr);
}

TEST(Watch, NewConditionsAreLearned) {
  constexpr int kLearn_hours = 10;
  const ParameterTable table(daemon::table1());
  WatchOptions options;
  options.quiet_learn_hours = kLearn_hours;
  const auto watch_of = [&](bool amplitude) {
    options.amplitude = amplitude;
    return Watch(table, options, {5, 1, 2.5, 10}, std::nullopt);
  };
  const auto go_on = [](Watch& from, Watch& to) {
    StateWriter writer;
    writer(from);
    StateReader reader(writer.bytes());
    reader(to);
    return reader.whole();
  };
  Watch half = watch_of(false), same = watch_of(false), other = watch_of(true);
  for (int h = 1; h <= kLearn_hours / 2; ++h) (void)half.push(window(table.size(), h));
  EXPECT_NEAR(half.quiet_learned(), 0.5, 0.01);
  EXPECT_TRUE(go_on(half, same));
  EXPECT_EQ(same.quiet_learned(), half.quiet_learned());
  EXPECT_TRUE(go_on(half, other));
  EXPECT_EQ(other.quiet_learned(), 0);
  for (int h = 6; h <= kLearn_hours + 1; ++h) (void)half.push(window(table.size(), h));
  ASSERT_NE(half.quiet_baseline(), nullptr);
  Watch known = watch_of(false), unknown = watch_of(true);
  EXPECT_TRUE(go_on(half, known));
  EXPECT_NE(known.quiet_baseline(), nullptr);
  EXPECT_TRUE(go_on(half, unknown));
  EXPECT_EQ(unknown.quiet_baseline(), nullptr);
}

}  // namespace dependence_test
}  // namespace framewatch::estimator
