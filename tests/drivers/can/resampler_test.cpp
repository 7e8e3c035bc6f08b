// SPDX-License-Identifier: MIT
#include "drivers/can/resampler.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <random>

#include <gtest/gtest.h>

namespace framewatch::drivers {
namespace resampler_test {

constexpr double kGrid_us = 10000;
constexpr double kError = 2e-4;  ///< of the amplitude, up to 20 Hz of 100 Hz
constexpr double kPhase_rad = 2e-4;

double wave(double hz, double time_us) {
  return std::sin(2 * M_PI * hz * time_us * 1e-6 + 0.3);
}

std::map<std::int64_t, double> resampled(double hz, double ppm, double phase_us,
                                         const std::function<bool(int)>& lost, int samples,
                                         Resampler& resampler) {
  std::map<std::int64_t, double> out;
  const double period_us = kGrid_us * (1 + 1e-6 * ppm);
  for (int k = 0; k < samples; ++k) {
    const double time_us = 1e9 + phase_us + period_us * k;
    if (!lost(k))
      resampler.add(k, time_us, period_us, wave(hz, time_us), [&](std::int64_t at, double value) {
        EXPECT_TRUE(out.emplace(at, value).second);
      });
  }
  return out;
}

TEST(Resampler, KeepsAmplitudeAndPhaseUpToTwentyHertz) {
  for (const double hz : {0.5, 5.0, 12.0, 20.0})
    for (const double ppm : {-100.0, 100.0}) {
      Resampler resampler(kGrid_us);
      const auto out = resampled(
          hz, ppm, 3456, [](int) { return false; }, 20000, resampler);
      ASSERT_GT(out.size(), 19900u);
      double worst = 0, in_phase = 0, quadrature = 0;
      for (const auto& [at, value] : out) {
        EXPECT_EQ(at % 10000, 0);
        const double time_us = static_cast<double>(at);
        worst = std::max(worst, std::abs(value - wave(hz, time_us)));
        in_phase += value * wave(hz, time_us);
        quadrature += value * std::cos(2 * M_PI * hz * time_us * 1e-6 + 0.3);
      }
      EXPECT_LT(worst, kError) << hz << " Hz";
      if (hz > 1) {
        EXPECT_LT(std::abs(quadrature / in_phase), kPhase_rad) << hz;
      }
    }
}

TEST(Resampler, SkipsALeapOfYearsAtOnce) {
  Resampler resampler(kGrid_us);
  const double years_us = 5e17;
  int given = 0;
  for (int k = 0; k < 200; ++k)
    resampler.add(k, (k < 100 ? 1e9 : years_us) + kGrid_us * k, kGrid_us, 1,
                  [&](std::int64_t, double value) { given += value > 0.9; });
  EXPECT_GT(given, 150);
  EXPECT_LT(given, 250);
}

TEST(Resampler, FillsOneLostSampleButNotTwo) {
  Resampler resampler(kGrid_us);
  const auto out = resampled(
      3, 20, 5000, [](int k) { return k == 100 || k == 200 || k == 201; }, 400, resampler);
  EXPECT_EQ(resampler.repaired(), 1);
  const auto at = [&](int k) { return out.contains(1'000'000'000 + 10000LL * k); };
  for (int k = 90; k < 115; ++k) EXPECT_TRUE(at(k)) << k;
  EXPECT_FALSE(at(201));
  EXPECT_TRUE(at(194) && at(208));
  for (const auto& [time, value] : out)
    EXPECT_NEAR(value, wave(3, static_cast<double>(time)), 3e-3);
}

TEST(Resampler, KeepsOvertakenSamples) {
  Resampler resampler(kGrid_us), straight(kGrid_us);
  std::map<std::int64_t, double> a, b;
  for (int k = 0; k < 300; ++k) {
    const int number = k % 10 == 3 ? k + 1 : k % 10 == 4 ? k - 1 : k;
    const auto add = [](Resampler& r, int n, std::map<std::int64_t, double>& out) {
      r.add(n, 1e9 + 1234 + 10000.0 * n, 10000, wave(2, 1e4 * n),
            [&](std::int64_t at, double value) { out[at] = value; });
    };
    add(resampler, number, a);
    add(straight, k, b);
  }
  EXPECT_EQ(a, b);
}

TEST(Resampler, ContinuesAfterALongSilence) {
  Resampler resampler(kGrid_us);
  const auto out = resampled(
      2, 0, 1000, [](int k) { return k >= 500 && k < 5000; }, 6000, resampler);
  EXPECT_GT(out.size(), 1450u);
  for (const auto& [time, value] : out)
    EXPECT_NEAR(value, wave(2, static_cast<double>(time)), kError);
}

}  // namespace resampler_test
}  // namespace framewatch::drivers
