// SPDX-License-Identifier: MIT
// Tests how readings of weather are judged: wrong units, clocks, stuck and absent sensors.
#include "daemon/monitor/estimation/covariate_guard.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include <gtest/gtest.h>

#include "daemon/base/clocks.h"
#include "estimator/state/archive.h"

namespace framewatch::daemon {
namespace covariate_guard_test {

constexpr std::int64_t kStart_us = 1'795'305'600'000'000;  // 2026-11-22T00:00:00Z
constexpr std::int64_t kMinute_us = 60 * kSecond_us, kEvery_us = 10 * kMinute_us;
using enum ReadingTrouble;

WeatherSettings outside() {
  WeatherSettings w;
  w.name = "outside_degc";
  w.stuck_after_s = covariate_unit(w.name)->stuck_after_s;
  return w;
}

double degc(std::int64_t time_us) {
  return 10 + 5 * std::sin(2 * M_PI * static_cast<double>(time_us % kDay_us) / kDay_us);
}

/// A thermometer with a reading every ten minutes.
class Thermometer {
 public:
  /// Reads for a duration; `change` makes the value of the true one, `off_us` is the error of its
  /// clock.
  template <typename Change>
  void read(std::int64_t duration_us, Change change, std::int64_t off_us = 0) {
    for (const std::int64_t end_us = now_us + duration_us; now_us < end_us; now_us += kEvery_us) {
      guard.tell(now_us);
      guard.take(now_us + off_us, change(degc(now_us)), now_us);
    }
  }
  void read(std::int64_t duration_us) {
    read(duration_us, [](double v) { return v; });
  }
  void wait(std::int64_t duration_us) {
    for (const std::int64_t end_us = now_us + duration_us; now_us < end_us; now_us += kEvery_us)
      guard.tell(now_us);
  }

  WeatherSettings settings = outside();
  CovariateGuard guard{settings};
  std::int64_t now_us = kStart_us;
};

TEST(CovariateGuard, TakesOrdinaryReadings) {
  Thermometer t;
  t.read(10 * kDay_us);
  EXPECT_EQ(t.guard.accepted(), 10 * 144);
  EXPECT_EQ(t.guard.rejected(), 0);
  EXPECT_EQ(t.guard.trouble(), none);
  EXPECT_EQ(t.guard.value_us(), t.now_us - kEvery_us);
  EXPECT_NEAR(t.guard.take_mean().value, 10, 1e-6);
  EXPECT_TRUE(std::isnan(t.guard.take_mean().value));
}

TEST(CovariateGuard, RejectsKelvinAndTellsOnceItIsNotAGlitch) {
  Thermometer t;
  t.read(kDay_us);
  const auto kelvin = [](double v) { return v + 273.15; };
  t.read(2 * kEvery_us, kelvin);
  EXPECT_EQ(t.guard.trouble(), none);
  t.read(kEvery_us, kelvin);
  EXPECT_EQ(t.guard.trouble(), impossible);
  EXPECT_EQ(t.guard.rejected(), 3);
  EXPECT_LT(t.guard.value(), 20);
  t.read(2 * kEvery_us);
  EXPECT_EQ(t.guard.trouble(), impossible);
  t.read(kEvery_us);
  EXPECT_EQ(t.guard.trouble(), none);
}

TEST(CovariateGuard, RejectsFahrenheitAsLongAsItComes) {
  Thermometer t;
  t.read(kDay_us);
  t.read(40 * kDay_us, [](double v) { return 1.8 * v + 32; });
  EXPECT_EQ(t.guard.trouble(), jump);
  EXPECT_LT(t.guard.value(), 20);
  EXPECT_GT(t.guard.refused(), 40);
  t.read(kDay_us);
  EXPECT_EQ(t.guard.trouble(), none);
}

TEST(CovariateGuard, AWrongFirstReadingDoesNotKeepOthersOut) {
  Thermometer t;
  t.read(kEvery_us, [](double) { return 79.0; });
  t.read(kDay_us);
  EXPECT_EQ(t.guard.trouble(), none);
  EXPECT_EQ(t.guard.rejected(), 0);
  EXPECT_LT(t.guard.value(), 20);
}

TEST(CovariateGuard, RejectsAStuckSensorUntilItMovesAgain) {
  Thermometer t;
  t.read(kDay_us);
  t.read(30 * kDay_us, [](double) { return -5.0; });
  EXPECT_EQ(t.guard.trouble(), stuck);
  EXPECT_NEAR(static_cast<double>(t.guard.rejected()), 27 * 144, 2);
  t.read(kDay_us);
  EXPECT_EQ(t.guard.trouble(), none);
}

TEST(CovariateGuard, AnUnchangedHumidityIsNotStuck) {
  WeatherSettings w;
  w.name = "humidity_pct";
  CovariateGuard guard(w);
  for (int i = 0; i < 1000; ++i)
    guard.take(kStart_us + i * 6 * kEvery_us, 100, kStart_us + i * 6 * kEvery_us);
  EXPECT_EQ(guard.accepted(), 1000);
}

TEST(CovariateGuard, TellsThatASensorIsAwayForAMonthAndTakesItBack) {
  Thermometer t;
  t.read(kDay_us);
  const std::int64_t last_us = t.guard.value_us();
  t.wait(5 * 3600 * kSecond_us);
  EXPECT_EQ(t.guard.trouble(), none);
  t.wait(30 * kDay_us);
  EXPECT_EQ(t.guard.trouble(), away);
  EXPECT_EQ(t.guard.trouble_since_us(), last_us);
  t.read(kEvery_us, [](double v) { return v - 35; });  // another season
  EXPECT_EQ(t.guard.trouble(), none);
  EXPECT_EQ(t.guard.rejected(), 0);
}

TEST(CovariateGuard, TellsThatASensorNeverCame) {
  Thermometer t;
  t.wait(kDay_us);
  EXPECT_EQ(t.guard.trouble(), away);
  EXPECT_EQ(t.guard.value_us(), 0);
}

TEST(CovariateGuard, RejectsValuesOfTheFutureAndOfThePast) {
  for (const auto& [off_us, expected] :
       {std::pair{7 * kDay_us, future}, std::pair{-7 * kDay_us, past}}) {
    Thermometer t;
    t.read(kDay_us);
    t.read(
        7 * kDay_us, [](double v) { return v; }, off_us);
    EXPECT_EQ(t.guard.trouble(), expected);
    EXPECT_EQ(t.guard.rejected(), 7 * 144);
    EXPECT_LE(t.guard.value_us(), kStart_us + kDay_us);
    t.read(kDay_us);
    EXPECT_EQ(t.guard.trouble(), none);
    EXPECT_EQ(t.guard.accepted(), 2 * 144);
  }
}

TEST(CovariateGuard, GoesOnAfterTheAccelerometersClockWasAheadForAWeek) {
  Thermometer t;
  t.read(kDay_us);
  t.now_us += 7 * kDay_us;  // readings count by the same clock
  t.read(kDay_us);
  EXPECT_EQ(t.guard.trouble(), none);
  t.now_us -= 7 * kDay_us;
  t.read(kDay_us);
  EXPECT_EQ(t.guard.trouble(), none);
  EXPECT_GE(t.guard.accepted(), 3 * 144 - 2);
}

TEST(CovariateGuard, IgnoresRepetitionsNanAndFloods) {
  Thermometer t;
  t.read(kDay_us);
  const std::int64_t accepted = t.guard.accepted();
  for (int i = 0; i < 100; ++i) {
    EXPECT_FALSE(t.guard.take(t.guard.value_us(), 9, t.now_us));
    EXPECT_FALSE(t.guard.take(t.now_us, std::nan(""), t.now_us));
    EXPECT_FALSE(t.guard.take(t.now_us, std::numeric_limits<double>::infinity(), t.now_us));
  }
  for (int i = 0; i < 1000; ++i)
    t.guard.take(t.now_us + i * 10'000, 10 + 0.001 * i, t.now_us + i * 10'000);
  EXPECT_EQ(t.guard.accepted(), accepted + 10);
  EXPECT_EQ(t.guard.rejected(), 0);
  t.guard.take(INT64_MAX, 10, INT64_MIN);
  t.guard.take(INT64_MIN, 10, INT64_MAX);
  EXPECT_EQ(t.guard.rejected(), 2);
}

TEST(CovariateGuard, ContinuesFromItsState) {
  Thermometer a, b;
  a.read(kDay_us);
  a.read(2 * kEvery_us, [](double v) { return v + 273.15; });
  estimator::StateWriter writer;
  a.guard.archive(writer);
  estimator::StateReader reader(writer.bytes());
  b.guard.archive(reader);
  ASSERT_TRUE(reader.whole());
  b.now_us = a.now_us;
  for (Thermometer* t : {&a, &b}) t->read(kEvery_us, [](double v) { return v + 273.15; });
  EXPECT_EQ(b.guard.trouble(), impossible);
  EXPECT_EQ(b.guard.rejected(), a.guard.rejected());
  EXPECT_EQ(b.guard.take_mean().value, a.guard.take_mean().value);
}

}  // namespace covariate_guard_test
}  // namespace framewatch::daemon
