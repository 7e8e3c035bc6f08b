// SPDX-License-Identifier: MIT
// Simulated series behind strong motion: recovery, lasting loss, both, too few windows, and an
// intact building that is only softer while it moves more.
#include "estimator/watch/recovery.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "estimator/simulate/random.h"
#include "estimator/state/archive.h"

namespace framewatch::estimator {
namespace recovery_test {

// Limits.
constexpr int kRuns = 200;
constexpr int kMaxOutside = 20;  // of kRuns, of intervals of 95 %: 5 % are expected
constexpr int kMaxWrong = 0;     // verdicts that the truth contradicts
constexpr int kMinLastingDay = 190, kMinRecoveringDay = 190;  // of kRuns, after a day

constexpr double kBaseline = 5e9;  // N/m
constexpr double kWindow_s = 5, kLong_s = 3600, kDay_s = 86400;
constexpr double kNoise = 0.01, kLongNoise = 0.004;  // relative, of a window
constexpr double kStrong_m = 1e-2, kWeak_m = 2e-4;   // rms deformation
/// Like the six-story building of San Bernardino: 13 % over a factor of 23.
constexpr double kPerLog = 0.13 / 3.14;

Time at(double s) {
  return from_microseconds(static_cast<std::int64_t>(1e6 * s));
}

/// The curve of the intact element as it was learned: 12 amplitudes over the whole range.
AmplitudeCurve learned_curve(double per_log = kPerLog) {
  std::vector<AmplitudePoint> points;
  for (int i = 0; i < 12; ++i) {
    const double a = kWeak_m * std::pow(kStrong_m / kWeak_m, i / 11.0);
    const double ratio = 1 - per_log * std::log(a / kWeak_m);
    points.push_back({a, kBaseline * ratio, 0.002 * kBaseline});
  }
  return AmplitudeCurve(kBaseline, 0.002, points);
}

struct Series {
  /// Returns the loss at a time since the strong motion, s.
  std::function<double(double)> loss = [](double) { return 0.0; };
  double until_s = kDay_s;
  double per_log = kPerLog;  ///< of the element, softening per unit of ln(amplitude)
  bool curve = true;         ///< the curve was learned
  double noise = kNoise;
};

/// Returns the amplitude, which decays like a structure's coda and its aftershocks to the weak
/// motion of street traffic.
double amplitude_m(double s) {
  return std::max(kWeak_m, 0.3 * kStrong_m * std::min(1.0, 20 / s));
}

/// Returns the mean over a window.
double mean_loss(const Series& s, double from_s, double to_s) {
  constexpr int kParts = 24;
  double sum = 0;
  for (int i = 0; i < kParts; ++i) sum += s.loss(from_s + (to_s - from_s) * (i + 0.5) / kParts);
  return sum / kParts;
}

/// Windows: all of the first ten minutes' stronger motion, then one a minute, and long ones.
Recovery after(const Series& s, std::uint64_t seed, double begin_s = 1000) {
  const AmplitudeCurve curve = s.curve ? learned_curve() : AmplitudeCurve();
  Random random(seed);
  // All windows share the error of the baselines.
  const double off = 0.002 * random.normal(), long_off = 0.002 * random.normal();
  Recovery out(0.03);
  out.begin(at(begin_s));
  double long_from_s = 0;
  for (double t = 0; t < s.until_s; t += t < 600 ? kWindow_s : t < 7200 ? 60 : 600) {
    const double a = amplitude_m(t + kWindow_s / 2);
    const double intact = kBaseline * (1 - s.per_log * std::log(a / kWeak_m));
    const double value =
        intact * (1 - mean_loss(s, t, t + kWindow_s)) * (1 + off + s.noise * random.normal());
    out.push(recovery_window(at(begin_s + t), at(begin_s + t + kWindow_s), value, s.noise * value,
                             a, kBaseline, 0.002 * kBaseline, curve, kWeak_m));
    if (t + kWindow_s < long_from_s + kLong_s) continue;
    const double slow = 1.02 * kBaseline * (1 - mean_loss(s, long_from_s, long_from_s + kLong_s)) *
                        (1 + long_off + kLongNoise * random.normal());
    RecoveryWindow w = recovery_window(
        at(begin_s + long_from_s), at(begin_s + long_from_s + kLong_s), slow, kLongNoise * slow,
        kWeak_m, 1.02 * kBaseline, 0.002 * kBaseline, AmplitudeCurve(), kWeak_m);
    w.source = 1;
    out.push(w);
    long_from_s += kLong_s;
  }
  return out;
}

double recovers(double t) {
  return 0.09 - 0.015 * std::log10(std::max(t, 1.0) / 10);
}
double stays(double) {
  return 0.09;
}
/// Recovers for an hour, then stays.
double both(double t) {
  return recovers(std::min(t, 3600.0));
}

struct Count {
  int verdict[4] = {0, 0, 0, 0};
  int loss_outside = 0, later_outside = 0;
  int of(RecoveryVerdict v) const { return verdict[static_cast<int>(v)]; }
};

Count count(Series s, double until_s) {
  s.until_s = until_s;
  Count out;
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    const RecoveryLaw law = after(s, 1000 + run).law();
    ++out.verdict[static_cast<int>(law.verdict)];
    const double now = s.loss(law.time_s);
    if (std::abs(law.loss - now) > 1.96 * law.std_error) ++out.loss_outside;
    if (std::abs(law.later_loss - s.loss(law.later_s)) > 1.96 * law.later_error)
      ++out.later_outside;
  }
  return out;
}

TEST(Recovery, PredictsWhereARecoveringFrameEnds) {
  Series s;
  s.loss = recovers;
  for (const double until_s : {600.0, 3600.0, kDay_s}) {
    const Count c = count(s, until_s);
    EXPECT_LE(c.loss_outside, kMaxOutside) << until_s;
    EXPECT_LE(c.later_outside, kMaxOutside) << until_s;
    EXPECT_LE(c.of(RecoveryVerdict::recovered), kMaxWrong) << until_s;
  }
  EXPECT_GE(count(s, kDay_s).of(RecoveryVerdict::recovering), kMinRecoveringDay);
}

TEST(Recovery, CallsALossLastingOnceRecoveryIsExcluded) {
  Series s;
  s.loss = stays;
  for (const double until_s : {60.0, 600.0, 3600.0, kDay_s}) {
    const Count c = count(s, until_s);
    EXPECT_LE(c.loss_outside, kMaxOutside) << until_s;
    EXPECT_LE(c.of(RecoveryVerdict::recovered), kMaxWrong) << until_s;
    // Three errors: one of 740 noise series looks like a recovery.
    EXPECT_LE(c.of(RecoveryVerdict::recovering), 2) << until_s;
  }
  EXPECT_GE(count(s, kDay_s).of(RecoveryVerdict::lasting), kMinLastingDay);
}

TEST(Recovery, CallsALossLastingWhenRecoveryStops) {
  Series s;
  s.loss = both;
  const RecoveryLaw hour = [&] {
    s.until_s = 3600;
    return after(s, 5).law();
  }();
  EXPECT_EQ(hour.verdict, RecoveryVerdict::recovering);
  const Count week = count(s, 7 * kDay_s);
  EXPECT_GE(week.of(RecoveryVerdict::lasting), 180);
  EXPECT_LE(week.of(RecoveryVerdict::recovering), 4);
  EXPECT_LE(week.loss_outside, kMaxOutside);
}

TEST(Recovery, ReportsNoLossForSofteningInStrongMotion) {
  Series s;
  for (const double until_s : {60.0, 600.0, kDay_s}) {
    const Count c = count(s, until_s);
    EXPECT_LE(c.of(RecoveryVerdict::lasting) + c.of(RecoveryVerdict::recovering), 1) << until_s;
    EXPECT_LE(c.loss_outside, kMaxOutside) << until_s;
  }
  EXPECT_GE(count(s, kDay_s).of(RecoveryVerdict::recovered), 190);
}

TEST(Recovery, ReportsNoLossForSofteningWithoutAnAmplitudeCurve) {
  // 4 % per unit of the logarithm, where nothing was learned and 3.5 % +- is assumed.
  Series s;
  s.curve = false;
  for (const double until_s : {60.0, 600.0, kDay_s}) {
    const Count c = count(s, until_s);
    EXPECT_EQ(c.of(RecoveryVerdict::lasting) + c.of(RecoveryVerdict::recovering), 0) << until_s;
  }
}

/// The table of docs/equations.md, recovery.
TEST(Recovery, IntervalsHoldAndVerdictsAreRight) {
  struct Case {
    const char* name;
    double (*loss)(double);
    bool curve;
    std::vector<double> until_s;
    RecoveryVerdict wrong;
  };
  const auto none = [](double) { return 0.0; };
  for (const Case& c :
       {Case{"recovers", recovers, true, {60, 600, kDay_s}, RecoveryVerdict::lasting},
        {"stays", stays, true, {60, 600, kDay_s}, RecoveryVerdict::recovered},
        {"both", both, true, {3600, kDay_s}, RecoveryVerdict::recovered},
        {"none", none, true, {60, kDay_s}, RecoveryVerdict::lasting},
        {"stays, no curve", stays, false, {600, 3600}, RecoveryVerdict::recovered}})
    for (const double until_s : c.until_s) {
      const Count n = count({c.loss, 0, kPerLog, c.curve, kNoise}, until_s);
      std::printf(
          "%-16s after %6.0f s: not known %3d, recovering %3d, lasting %3d, recovered %3d, "
          "loss outside %2d\n",
          c.name, until_s, n.of(RecoveryVerdict::not_known), n.of(RecoveryVerdict::recovering),
          n.of(RecoveryVerdict::lasting), n.of(RecoveryVerdict::recovered), n.loss_outside);
      EXPECT_LE(n.loss_outside, kMaxOutside) << c.name << ' ' << until_s;
      EXPECT_EQ(n.of(c.wrong), kMaxWrong) << c.name << ' ' << until_s;
    }
}

TEST(Recovery, FindsALossBesideSoftening) {
  Series s;
  s.loss = stays;
  const RecoveryLaw law = after(s, 3).law();
  EXPECT_NEAR(law.loss, 0.09, 4 * law.std_error);
  EXPECT_LT(law.std_error, 0.01);
  EXPECT_GT(law.stays, 0.03);
  EXPECT_LT(law.stays, 0.09);
}

TEST(Recovery, GivesTheReasonIfWindowsAreFew) {
  Recovery r;
  EXPECT_FALSE(r.active());
  r.begin(at(100));
  EXPECT_EQ(r.law().verdict, RecoveryVerdict::not_known);
  EXPECT_EQ(r.law().reason, RecoveryReason::few_windows);
  for (int i = 0; i < 3; ++i) r.push({at(100 + 5 * i), at(105 + 5 * i), -0.1, 0.01, 0, 0, 0});
  EXPECT_EQ(r.law().reason, RecoveryReason::few_windows);
  r.begin(at(200));
  for (int i = 20; i < 26; ++i) r.push({at(200 + 5 * i), at(205 + 5 * i), -0.1, 0.01, 0, 0, 0});
  EXPECT_EQ(r.law().reason, RecoveryReason::short_time);
  r.begin(at(200));
  for (int i = 0; i < 20; ++i) r.push({at(200 + 5 * i), at(205 + 5 * i), -0.1, 0.1, 0, 0, 0});
  EXPECT_EQ(r.law().reason, RecoveryReason::inexact);
  r.begin(at(200));
  for (int i = 0; i < 20; ++i) r.push({at(200 + 5 * i), at(205 + 5 * i), -0.1, 0.001, 0.1, 0, 0});
  EXPECT_EQ(r.law().reason, RecoveryReason::baseline);
  r.begin(at(200));
  for (int i = 0; i < 20; ++i) r.push({at(200 + 5 * i), at(205 + 5 * i), -0.1, 0.001, 0, 0.1, 0});
  EXPECT_EQ(r.law().reason, RecoveryReason::amplitude);
}

TEST(Recovery, LeavesOutOverlappingWindowsAndThoseOfTheMotion) {
  Recovery one, both;
  for (Recovery* r : {&one, &both}) r->begin(at(100));
  both.push({at(98), at(103), 7, 0.001, 0, 0, 0});  // began during the motion
  for (int i = 0; i < 100; ++i) {
    const RecoveryWindow w{at(100 + 5 * i), at(105 + 5 * i), -0.1 + 1e-4 * i, 0.01, 0, 0, 0};
    one.push(w);
    both.push(w);
    both.push({at(103 + 5 * i), at(108 + 5 * i), 7, 0.001, 0, 0, 0});
  }
  EXPECT_EQ(both.law().loss, one.law().loss);
  EXPECT_EQ(both.law().std_error, one.law().std_error);
}

TEST(Recovery, BadWindowsChangeNothing) {
  Recovery r;
  r.push({at(0), at(5), -0.1, 0.01, 0, 0, 0});
  r.begin(at(100));
  r.push({at(100), at(105), NAN, 0.01, 0, 0, 0});
  r.push({at(105), at(110), -0.1, 0, 0, 0, 0});
  r.push({at(110), at(115), -0.1, 0.01, 0, 0, 9});
  EXPECT_EQ(r.law().time_s, 0);
  EXPECT_EQ(r.loss_at(10).count, 0);
}

TEST(Recovery, IsRenewedOnceAtTenMinutesAnHourAndADay) {
  Recovery r;
  EXPECT_FALSE(r.renewal_due(at(1e9)));
  r.begin(at(0));
  EXPECT_FALSE(r.renewal_due(at(700)));  // no window yet
  for (int i = 0; i < 20; ++i) r.push({at(5 * i), at(5 * i + 5), -0.1, 0.01, 0, 0, 0});
  EXPECT_FALSE(r.renewal_due(at(599)));
  EXPECT_TRUE(r.renewal_due(at(600)));
  EXPECT_FALSE(r.renewal_due(at(601)));
  EXPECT_FALSE(r.renewal_due(at(3700)));  // no newer window
  r.push({at(3690), at(3695), -0.1, 0.01, 0, 0, 0});
  EXPECT_TRUE(r.renewal_due(at(3700)));
  r.push({at(90'000), at(90'005), -0.1, 0.01, 0, 0, 0});
  EXPECT_TRUE(r.renewal_due(at(90'006)));
  EXPECT_FALSE(r.renewal_due(at(1e6)));
  EXPECT_TRUE(r.is_of(at(-100)));
  EXPECT_TRUE(r.is_of(at(500)));
  EXPECT_FALSE(r.is_of(at(-1000)));
  EXPECT_FALSE(r.is_of(at(700)));  // another cause
}

TEST(Recovery, ContinuesFromItsState) {
  Series s;
  s.loss = recovers;
  s.until_s = 3600;
  Recovery r = after(s, 7), again;
  StateWriter writer;
  writer(r);
  StateReader reader(writer.bytes());
  reader(again);
  ASSERT_TRUE(reader.whole());
  for (Recovery* each : {&r, &again})
    each->push({at(10'000), at(10'005), -0.05, 0.01, 0.002, 0, 0});
  EXPECT_EQ(r.law().loss, again.law().loss);
  EXPECT_EQ(r.law().later_error, again.law().later_error);
  std::vector<std::uint8_t> bytes = writer.bytes();
  for (std::size_t i = 0; i < bytes.size(); i += 7) {
    std::vector<std::uint8_t> damaged = bytes;
    damaged[i] ^= 0xff;
    Recovery any;
    StateReader damaged_reader(damaged);
    damaged_reader(any);
    if (damaged_reader.whole()) (void)any.law();
  }
}

}  // namespace recovery_test
}  // namespace framewatch::estimator
