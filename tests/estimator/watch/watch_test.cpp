// SPDX-License-Identifier: MIT
#include "estimator/watch/watch.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/tools/lab/study_buildings.h"
#include "estimator/numeric/nan.h"
#include "estimator/simulate/random.h"
#include "tests/support/shaken_minute.h"

namespace framewatch::estimator {
namespace watch_test {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kWindow_s = 2.5;
constexpr double kError = 0.01;

/// A window of one parameter that ends at end_s.
WindowEstimate window(double end_s, double value, double error = kError) {
  WindowEstimate e(1);
  e.end = from_microseconds(std::llround(1e6 * end_s));
  e.start = e.end - SensorClock::duration(std::llround(1e6 * kWindow_s));
  e.status = WindowStatus::valid;
  e.value = {value};
  e.std_error = {error};
  e.prior_share = e.noise_share = {0.0};
  e.reason = {std::isnan(value) ? Observability::quiet : Observability::observable};
  return e;
}

Baseline known_baseline() {
  Baseline b(1);
  b.value = {1};
  b.std_error = {0.001};
  return b;
}

TEST(BaselineLearner, WeighsWindowsThatDoNotOverlap) {
  BaselineLearner learner({Watched{}}, 2 * (kWindow_s - 0.1));
  EXPECT_FALSE(learner.push(window(3, 1.00, 0.01), 4));
  EXPECT_FALSE(learner.push(window(4, 9.00, 0.01)));  // overlaps
  EXPECT_TRUE(learner.push(window(6, 1.03, 0.02), 9));
  EXPECT_FALSE(learner.push(window(9, 5.00)));  // already complete
  const Baseline b = learner.baseline();
  EXPECT_NEAR(b.value[0], (1.00 + 1.03 / 4) / 1.25, 1e-12);
  // Two windows 0.03 apart scatter more than 0.01 and 0.02 explain: 0.03^2 / (0.01^2 + 0.02^2).
  EXPECT_NEAR(b.std_error[0], 0.01 / std::sqrt(1.25) * std::sqrt(9.0 / 5), 1e-12);
  EXPECT_NEAR(b.degc[0], 5, 1e-12);
}

TEST(BaselineLearner, LeavesOutParametersThatMostWindowsDoNotShow) {
  BaselineLearner learner({Watched{}}, kInfinity);
  for (const double end_s : {3.0, 6.0}) EXPECT_FALSE(learner.push(window(end_s, kNaN)));
  EXPECT_FALSE(learner.push(window(9, 1)));
  EXPECT_FALSE(learner.so_far().knows(0));
  EXPECT_FALSE(learner.push(window(12, 1)));
  EXPECT_TRUE(learner.so_far().knows(0));
  EXPECT_FALSE(learner.baseline().knows(0));
}

TEST(BaselineLearner, LearnsUntilItIsExact) {
  constexpr double kSmallest = 0.03;
  const double exact = BaselineLearner::kExact * kSmallest;
  BaselineLearner learner({Watched{kSmallest}}, kWindow_s);
  int windows = 1;
  while (!learner.push(window(3.0 * windows, 1)) && windows < 100) ++windows;
  EXPECT_EQ(windows, std::ceil(kError * kError / exact / exact));
  EXPECT_LE(learner.baseline().std_error[0], exact);
}

/// In weak motion every window has the same pull of the prior, which no mean reveals.
TEST(BaselineLearner, LeavesOutValuesPulledTowardTheDesign) {
  BaselineLearner learner({Watched{0.03, 0.1}}, kWindow_s);
  double t = 3;
  for (; t < 300; t += 3) {
    WindowEstimate pulled = window(t, 1.05, 0.001);
    pulled.prior_share = pulled.noise_share = {0.06};
    EXPECT_FALSE(learner.push(pulled));
  }
  EXPECT_TRUE(learner.push(window(t, 1, 0.002)));
  EXPECT_EQ(learner.baseline().value[0], 1);
}

TEST(ChangeDetector, FindsAChangeItsSizeAndItsEnd) {
  constexpr double kChange = -0.05, kFrom_s = 500, kTo_s = 1000;
  constexpr double kDelay_s = 3 * kWindow_s;
  ChangeDetector detector(known_baseline(), {{0.03}}, 16);
  Random random(3);
  double found_s = 0, gone_s = 0;
  for (double t = 3; t < 1500; t += 0.5) {
    const double truth = t >= kFrom_s + kWindow_s && t < kTo_s ? 1 + kChange : 1;
    detector.push(window(t, truth + kError * random.normal()));
    if (detector.changed(0) && found_s == 0) found_s = t;
    if (!detector.changed(0) && found_s > 0 && gone_s == 0) gone_s = t;
    if (t != kTo_s) continue;
    const Change change = detector.change(0);
    EXPECT_NEAR(change.ratio, kChange, 4 * change.std_error);
    EXPECT_LT(change.std_error, 0.002);
    EXPECT_NEAR(1e-6 * static_cast<double>(to_microseconds(change.since)), kFrom_s, kDelay_s);
  }
  EXPECT_GT(found_s, kFrom_s);
  EXPECT_LT(found_s, kFrom_s + kWindow_s + kDelay_s);
  EXPECT_GT(gone_s, kTo_s);
  EXPECT_LT(gone_s, kTo_s + 10 * kWindow_s);
}

/// The watch stays silent however small the error of a window is compared with the least change.
TEST(ChangeDetector, RaisesFalseAlarmsAsRarelyAsItsThresholdPromises) {
  constexpr double kThreshold = 5;
  constexpr int kWindows = 100'000, kTests = 2 * ChangeDetector::kSizes;
  const double most = kTests * kWindows * std::exp(-kThreshold - ChangeDetector::kOvershoot);
  for (const double least : {0.003, 0.01, 0.02, 0.04}) {
    ChangeDetector detector(known_baseline(), {{least}}, kThreshold);
    Random random(4);
    int alarms = 0;
    bool before = false;
    for (int i = 0; i < kWindows; ++i) {  // far apart: independent
      detector.push(window(3.0 * (i + 1), 1 + kError * random.normal()));
      alarms += detector.changed(0) && !before ? 1 : 0;
      before = detector.changed(0);
    }
    EXPECT_LE(alarms, most) << least;
    EXPECT_GT(alarms, 0) << least;
  }
}

TEST(ChangeDetector, OneShortWindowDoesNotSuffice) {
  ChangeDetector detector(known_baseline(), {{0.03}}, 16);
  detector.push(window(3, 0.6));
  EXPECT_FALSE(detector.changed(0));
  detector.push(window(6, 0.6));
  EXPECT_TRUE(detector.changed(0));
}

TEST(ChangeDetector, AWindowOfSecondsSuffices) {
  ChangeDetector detector(known_baseline(), {{0.03}}, 16);
  WindowEstimate lost = window(6, 0.9);
  lost.start = lost.end - std::chrono::seconds(5);
  detector.push(lost);
  EXPECT_TRUE(detector.changed(0));
}

TEST(ChangeDetector, IgnoresValuesPulledTowardTheDesign) {
  ChangeDetector detector(known_baseline(), {{0.03, 0.1}}, 16);
  for (double t = 3; t < 100; t += 0.5) {
    WindowEstimate pulled = window(t, 0.9);
    pulled.prior_share = pulled.noise_share = {0.06};
    detector.push(pulled);
  }
  EXPECT_FALSE(detector.changed(0));
}

TEST(ChangeDetector, IgnoresUnobservableAndUnwatchedElementsAndThoseWithoutBaseline) {
  ChangeDetector unwatched(known_baseline(), {Watched{}}, 16), unknown(Baseline(1), {{0.03}}, 16),
      quiet(known_baseline(), {{0.03}}, 16);
  for (double t = 3; t < 100; t += 0.5) {
    unwatched.push(window(t, 0.5));
    unknown.push(window(t, 0.5));
    quiet.push(window(t, kNaN));
  }
  EXPECT_FALSE(unwatched.changed(0));
  EXPECT_FALSE(unknown.changed(0));
  EXPECT_FALSE(quiet.changed(0));
}

/// A building is learned while it hardly moves, its values pulled toward a design that is too
/// stiff. It then moves in traffic and at last loses 5 %.
TEST(Watch, ABaselineOfWeakMotionRaisesNoChangeInTraffic) {
  constexpr double kQuiet_s = 600, kDamage_s = 3300, kEnd_s = 3400, kSoon_s = 60;
  constexpr double kPull = 0.03, kPulledShare = 0.3;
  const ParameterTable table(daemon::table1());
  Watch watch(table, {}, {kWindow_s}, std::nullopt);
  Random random(5);
  int false_alarms = 0;
  double found_s = kInfinity;
  for (double t = kWindow_s; t < kEnd_s; t += 0.5) {
    WindowEstimate e = window(t, 1);
    const bool quiet = t < kQuiet_s || std::fmod(t, 600) < 300;
    for (int p = 0; p < table.size(); ++p) {
      const auto i = static_cast<std::size_t>(p);
      e.value.resize(i + 1), e.std_error.resize(i + 1, kError);
      const bool lost = p == 0 && t > kDamage_s;
      e.value[i] = (lost ? 0.95 : 1.0) + (quiet ? kPull : 0) + kError * random.normal();
    }
    e.prior_share.assign(e.value.size(), quiet ? kPulledShare : 0.0);
    e.noise_share.assign(e.value.size(), 0);
    e.reason.assign(e.value.size(), Observability::observable);
    e.amplitude.assign(e.value.size(), kNaN);
    for (const Alarm& alarm : watch.push(e)) {
      if (alarm.state != AlarmState::raised) continue;
      if (t > kDamage_s && alarm.parameter == 0)
        found_s = std::min(found_s, t - kDamage_s);
      else
        ++false_alarms;
    }
  }
  EXPECT_EQ(false_alarms, 0);
  EXPECT_LT(found_s, kSoon_s);
}

/// Issue 9: 20 of 20, 90 % within 9 s, no false alarm in 20 frame-hours, 1 % of
/// the other elements flagged. FRAMEWATCH_WATCH_RUNS=20 tests all of it.
TEST(Watch, FindsOnlyTheFrameThatLostATwentieth) {
  // Issue 38: at most .5 s later than the 4.92 s before it.
  constexpr double kMedian_s = 5.42, kLate_s = 9, kOthers = 0.01;
  constexpr int kUndamagedPerDamaged = 3;  // a minute of 20 frames each
  const char* wanted = std::getenv("FRAMEWATCH_WATCH_RUNS");
  const int runs = wanted != nullptr ? std::atoi(wanted) : 2;
  const test::ShakenMinute minute;
  std::vector<double> delay_s;
  int others = 0, others_watched = 0, false_alarms = 0;
  for (int run = 0; run < runs; ++run) {
    const auto seed = static_cast<std::uint64_t>(1000 + 10 * run);
    BaselineLearner learner(watched_parameters(minute.table(), {}), kInfinity);
    minute.run(seed, false, [&](const WindowEstimate& e) { (void)learner.push(e); });
    const auto fresh = [&] {
      return Watch(minute.table(), {}, minute.windows_s(), learner.so_far());
    };
    for (std::uint64_t i = 1; i <= kUndamagedPerDamaged; ++i) {
      Watch watch = fresh();
      minute.run(seed + i, false, [&](const WindowEstimate& e) {
        false_alarms += static_cast<int>(watch.push(e).size());
      });
    }
    Watch watch = fresh();
    double found_s = kInfinity;
    minute.run(seed + 9, true, [&](const WindowEstimate& e) {
      for (const Alarm& alarm : watch.push(e)) {
        if (alarm.state != AlarmState::raised) continue;
        if (alarm.parameter != minute.frame()) {
          ++others;
          continue;
        }
        found_s = 1e-6 * static_cast<double>(to_microseconds(alarm.found));
        EXPECT_LT(alarm.change.ratio, 0);
      }
    });
    others_watched += minute.table().size() / 2 - 1;
    delay_s.push_back(found_s - test::ShakenMinute::kDamage_s);
  }
  std::sort(delay_s.begin(), delay_s.end());
  const auto at = [&](double share) {
    return delay_s[static_cast<std::size_t>(std::ceil(share * runs)) - 1];
  };
  std::printf(
      "delay: median %.2f s, 90 %% within %.2f s, longest %.2f s; false alarms %d in %.1f "
      "frame-hours; other elements flagged %d of %d\n",
      at(0.5), at(0.9), delay_s.back(), false_alarms, runs * kUndamagedPerDamaged / 3.0, others,
      others_watched);
  EXPECT_GT(delay_s.front(), 0);
  EXPECT_LE(at(0.5), kMedian_s);
  EXPECT_LE(at(0.9), kLate_s);
  EXPECT_EQ(false_alarms, 0);
  EXPECT_LE(others, kOthers * others_watched);
}

}  // namespace watch_test
}  // namespace framewatch::estimator
