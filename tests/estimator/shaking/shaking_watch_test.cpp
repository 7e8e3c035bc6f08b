// SPDX-License-Identifier: MIT
#include "estimator/shaking/shaking_watch.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "estimator/numeric/nan.h"
#include "estimator/state/archive.h"

namespace framewatch::estimator {
namespace shaking_watch_test {

constexpr double kRate_hz = 100, kQuiet_s = 10, kMotion_hz = 2;
constexpr double kDriftError = 0.05;  // of the corner's gain at the motion's frequency

/// Two stories of one frame, a sensor on the base and on each floor.
class ShakingTest : public testing::Test {
 protected:
  ShakingTest() {
    structure_.stories = 2;
    structure_.frames_x = {"y1"};
    structure_.story_height = {3, 3};
    structure_.node_mass = {40, 40};
    for (int story = 0; story <= 2; ++story) {
      SensorAxis axis;
      axis.story = story;
      axis.frame = story > 0 ? 0 : -1;
      axes_.push_back(axis);
    }
  }
  ShakingWatch watch() const { return {{structure_, axes_, {}, {}, {}}, {0.1, kQuiet_s}}; }

  /// Moves in a sine from 20 to 30 s that begins and ends within two seconds, m.
  static double displacement(double t) {
    const double in = std::clamp(std::min(t - 20, 30 - t) / 2, 0.0, 1.0);
    return in * in * in * (10 - 15 * in + 6 * in * in) *
           std::sin(2 * std::numbers::pi * kMotion_hz * t);
  }
  /// Moves each floor by `amplitude_m` against the one below, on top of an offset.
  static SampleSet at(int i, double amplitude_m = 0.01) {
    constexpr double kStep_s = 1e-3;
    const double t = i / kRate_hz;
    const double moves =
        amplitude_m *
        (displacement(t + kStep_s) - 2 * displacement(t) + displacement(t - kStep_s)) /
        (kStep_s * kStep_s);
    return {from_microseconds(10'000LL * i), i, {0.3 + moves, -0.2 + 2 * moves, 0.1 + 3 * moves}};
  }
  static WindowEstimate window(double end_s, double value) {
    WindowEstimate e(4);
    e.end = from_microseconds(std::llround(1e6 * end_s));
    e.start = e.end - std::chrono::seconds(2);
    e.status = WindowStatus::valid;
    e.value = {value, 2, kNaN, kNaN};
    e.std_error = {0.01, 0.01, kNaN, kNaN};
    e.prior_share = e.noise_share = {0, 0, 0, 0};
    e.reason = {Observability::observable, Observability::observable, Observability::quiet,
                Observability::quiet};
    return e;
  }

  Structure structure_;
  std::vector<SensorAxis> axes_;
};

TEST_F(ShakingTest, IsReportedOnceWithItsTimesAndPeaks) {
  ShakingWatch w = watch();
  int ended = 0;
  for (int i = 0; i < 6000; ++i)
    if (w.push(at(i), nullptr)) {
      ++ended;
      EXPECT_NEAR(i / kRate_hz, 30 + kQuiet_s, 1);
    }
  ASSERT_EQ(ended, 1);
  const Shaking& s = w.ended();
  EXPECT_NEAR(1e-6 * static_cast<double>(to_microseconds(s.start)), 20, 1);
  EXPECT_NEAR(1e-6 * static_cast<double>(to_microseconds(s.end)), 30, 1);
  const double accel = 0.01 * std::pow(2 * std::numbers::pi * kMotion_hz, 2);
  for (int a = 0; a < 3; ++a)
    EXPECT_NEAR(s.peak.accel_mps2[static_cast<std::size_t>(a)] / ((a + 1) * accel), 1, 0.05) << a;
  for (const double drift : s.peak.drift_m) EXPECT_NEAR(drift / 0.01, 1, kDriftError);
  EXPECT_NEAR(s.peak.base_shear_n[0] / (40 * (2 + 3) * accel), 1, 0.05);
  EXPECT_TRUE(std::isnan(s.peak.base_shear_n[1]));  // no frames
  EXPECT_TRUE(std::isnan(s.gap_nrmse));
}

TEST_F(ShakingTest, AnInterruptionKeepsTheRestLevel) {
  ShakingWatch w = watch();
  for (int i = 0; i < 6000; ++i) {
    SampleSet set = at(i);
    if (i > 2450 && i < 2460) set.accel[2] = kNaN;  // a sensor returns in full motion
    (void)w.push(set, nullptr);
  }
  const double accel = 0.01 * std::pow(2 * std::numbers::pi * kMotion_hz, 2);
  EXPECT_NEAR(w.ended().peak.accel_mps2[2] / (3 * accel), 1, 0.05);
}

TEST_F(ShakingTest, ATimeWithoutSamplesIsReportedAndIsNotCalm) {
  // Longer than quiet_s, in the middle of the motion. Instants without a value are missing, too.
  for (const bool empty : {false, true}) {
    ShakingWatch w = watch();
    for (int i = 0; i < 6000; ++i) {
      SampleSet set = at(i);
      if (i >= 2400 && i < 2480 && empty) set.accel.assign(3, kNaN);
      (void)w.push(set, nullptr);
    }
    EXPECT_EQ(w.ended().unheard.size(), empty ? 1u : 0u);
  }
  for (const bool restart : {false, true}) {
    ShakingWatch w = watch();
    int ended = 0;
    for (int i = 0; i < 7000; ++i) {
      if (i >= 2400 && i < 2400 + 100 * kQuiet_s + 200) continue;
      if (i == 2400 + 100 * kQuiet_s + 200 && restart)
        w.came_up(from_microseconds(10'000LL * 2399), true);
      if (w.push(at(i), nullptr)) ++ended;
    }
    ASSERT_EQ(ended, 1);
    ASSERT_EQ(w.ended().unheard.size(), 1u);
    const Unheard& u = w.ended().unheard[0];
    EXPECT_TRUE(u.from_known);
    EXPECT_EQ(to_microseconds(u.from), 23'990'000);
    EXPECT_EQ(to_microseconds(u.to), 36'000'000);
    EXPECT_EQ(u.why, restart ? UnheardWhy::restart : UnheardWhy::no_samples);
    // Recorded calm begins at 36 s.
    EXPECT_NEAR(1e-6 * static_cast<double>(to_microseconds(w.ended().found)), 36 + kQuiet_s, 1);
  }
}

TEST_F(ShakingTest, ASilenceBeforeItIsReportedIfItMayHaveBegunThen) {
  for (const bool near : {false, true}) {
    ShakingWatch w = watch();
    for (int i = 0; i < 6000; ++i) {
      const int from = near ? 1400 : 100;
      if (i >= from && i < from + 200) continue;
      (void)w.push(at(i), nullptr);
    }
    EXPECT_EQ(w.ended().unheard.size(), near ? 1u : 0u);
  }
}

TEST_F(ShakingTest, AStartDuringItIsReported) {
  ShakingWatch w = watch();
  w.came_up(from_microseconds(0), false);
  for (int i = 2500; i < 6000; ++i) (void)w.push(at(i), nullptr);
  ASSERT_EQ(w.ended().unheard.size(), 1u);
  EXPECT_FALSE(w.ended().unheard[0].from_known);
  EXPECT_EQ(to_microseconds(w.ended().unheard[0].to), 25'000'000);
  EXPECT_EQ(w.ended().unheard[0].why, UnheardWhy::restart_no_raw);
}

TEST_F(ShakingTest, ManySilencesAreBounded) {
  ShakingWatch w = watch();
  for (int i = 0; i < 7000; ++i)
    if (i < 2000 || i > 3000 || i % 100 < 40) (void)w.push(at(i), nullptr);
  const std::vector<Unheard>& all = w.ended().unheard;
  ASSERT_EQ(all.size(), ShakingWatch::kMaxUnheard);
  for (std::size_t k = 1; k < all.size(); ++k) EXPECT_GE(all[k].from, all[k - 1].to);
  EXPECT_EQ(to_microseconds(all.back().to), 30'000'000);
}

TEST_F(ShakingTest, AVeryLongSilenceSeparatesTwoMotions) {
  ShakingWatch w = watch();
  int ended = 0;
  for (int i = 0; i < 6000; ++i) {
    SampleSet set = at(i);
    if (i >= 2500) set.time += std::chrono::seconds(3600);
    if (i >= 2500) set.index += 360'000;
    if (!w.push(set, nullptr)) continue;
    if (++ended > 1) continue;
    EXPECT_NEAR(1e-6 * static_cast<double>(to_microseconds(w.ended().end)), 25, 1);
    EXPECT_EQ(w.ended().unheard.size(), 1u);
  }
  EXPECT_EQ(ended, 2);
  EXPECT_EQ(w.ended().unheard.size(), 1u);  // the motion may have begun in it
}

TEST_F(ShakingTest, AFailedSensorHasNoPeakAndNoDrift) {
  ShakingWatch w = watch();
  for (int i = 0; i < 6000; ++i) {
    SampleSet set = at(i);
    set.accel[2] = kNaN;
    (void)w.push(set, nullptr);
  }
  EXPECT_TRUE(std::isnan(w.ended().peak.accel_mps2[2]));
  EXPECT_TRUE(std::isnan(w.ended().peak.drift_m[1]));
  EXPECT_GT(w.ended().peak.drift_m[0], 0);
}

TEST_F(ShakingTest, AKnockIsNoShaking) {
  ShakingWatch w = watch();
  for (int i = 0; i < 6000; ++i) {
    SampleSet set = at(i, 0);
    if (i == 2500) set.accel[0] += 5;
    EXPECT_FALSE(w.push(set, nullptr));
  }
}

TEST_F(ShakingTest, ComparesStiffnessBeforeAndAfter) {
  const auto stiffness = [&](const Baseline* baseline, bool before, bool after) {
    ShakingWatch w = watch();
    for (int i = 0; i < 6000; ++i) {
      const double t = i / kRate_hz;
      if (i % 10 == 0 &&
          ((t > 4 && t < 20 && before) || (t >= 23 && t < 30) || (t > 33 && t < 36 && after)))
        w.push(window(t, t < 26 ? 1.0 : 0.8));
      if (w.push(at(i), baseline)) return w.ended().stiffness[0];
    }
    return ShakenStiffness{};
  };
  const ShakenStiffness measured = stiffness(nullptr, true, true);
  EXPECT_EQ(measured.before_from, BeforeFrom::windows_before);
  EXPECT_TRUE(measured.free);
  EXPECT_NEAR(measured.ratio(), -0.2, 1e-9);
  EXPECT_NEAR(measured.std_error(), 0.01, 0.01);
  const ShakenStiffness first = stiffness(nullptr, false, false);
  EXPECT_EQ(first.before_from, BeforeFrom::first_windows);
  EXPECT_FALSE(first.free);
  EXPECT_LT(first.ratio(), 0);
  Baseline known(4);
  known.value[0] = 0.9;
  known.std_error[0] = 0.01;
  const ShakenStiffness given = stiffness(&known, true, true);
  EXPECT_EQ(given.before_from, BeforeFrom::baseline);
  EXPECT_NEAR(given.ratio(), 0.8 / 0.9 - 1, 1e-9);
}

TEST_F(ShakingTest, ContinuesFromItsState) {
  for (const int cut : {1500, 2100, 2900, 3500}) {
    ShakingWatch whole = watch(), first = watch(), second = watch();
    for (int i = 0; i < 700; ++i)
      (void)second.push(at(i, 0.02), nullptr);  // state that must not survive
    bool ended = false;
    for (int i = 0; i < 6000 && !ended; ++i) {
      if (i == cut) {
        StateWriter writer;
        writer(first);
        const std::vector<std::uint8_t> bytes = writer.bytes();
        StateReader reader(bytes);
        reader(second);
        ASSERT_TRUE(reader.whole());
      }
      ShakingWatch& part = i < cut ? first : second;
      if (i % 10 == 0 && i > 2000) {
        whole.push(window(i / kRate_hz, 1));
        part.push(window(i / kRate_hz, 1));
      }
      ended = whole.push(at(i), nullptr);
      ASSERT_EQ(part.push(at(i), nullptr), ended) << i;
    }
    ASSERT_TRUE(ended);
    EXPECT_EQ(second.ended().peak.drift_m, whole.ended().peak.drift_m);
    EXPECT_EQ(second.ended().peak.accel_mps2, whole.ended().peak.accel_mps2);
    EXPECT_EQ(second.ended().stiffness[0].after.value, whole.ended().stiffness[0].after.value);
  }
}

}  // namespace shaking_watch_test
}  // namespace framewatch::estimator
