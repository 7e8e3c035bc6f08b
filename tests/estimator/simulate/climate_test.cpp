// SPDX-License-Identifier: MIT
#include "estimator/simulate/climate.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace framewatch::estimator {
namespace climate_test {

constexpr double kJanuary2026_s = 1767225600;  // a Thursday
constexpr int kElements = 6, kYear_h = 24 * 365;

/// Returns a climate without anything that changes stiffness.
Climate still() {
  Climate c;
  c.per_degc = c.frozen_per_degc = c.per_pct = c.per_mps = 0;
  c.occupied_mass_ratio = c.wander_ratio = c.wander_alike_ratio = 0;
  return c;
}

TEST(ClimateStream, HasSeasonsNightsAndWorkdays) {
  ClimateStream stream(still(), kElements, kJanuary2026_s, 1);
  std::vector<double> january, july, night, afternoon;
  int occupied_h = 0;
  for (int h = 0; h < kYear_h; ++h) {
    const WeatherHour w = stream.next();
    const int day = h / 24;
    if (day < 31) january.push_back(w.outside_degc);
    if (day >= 181 && day < 212) july.push_back(w.outside_degc);
    if (h % 24 == 3) night.push_back(w.outside_degc);
    if (h % 24 == 15) afternoon.push_back(w.outside_degc);
    EXPECT_GE(w.humidity_pct, 0);
    EXPECT_LE(w.humidity_pct, 100);
    EXPECT_GT(w.wind_mps, 0);
    occupied_h += w.occupied_pct > 0 ? 1 : 0;
    EXPECT_EQ(stream.stiffness_factor(), std::vector<double>(kElements, 1));
  }
  const auto mean = [](const std::vector<double>& v) {
    double sum = 0;
    for (const double x : v) sum += x;
    return sum / static_cast<double>(v.size());
  };
  // 2 * 9 of the season, within what ten fronts of 3 degrees leave in a month's mean.
  EXPECT_NEAR(mean(july) - mean(january), 18, 4);
  EXPECT_NEAR(mean(afternoon) - mean(night), 8, 0.5);
  EXPECT_EQ(occupied_h, 261 * 10);  // 2026 has 261 days from Monday to Friday
}

TEST(ClimateStream, StiffnessFollowsTheTemperatureBehindItsLag) {
  Climate c = still();
  c.per_degc = -0.01;
  c.spread_ratio = c.front_degc = c.day_degc = 0;
  c.shortest_lag_days = c.longest_lag_days = 20;
  ClimateStream stream(c, 1, kJanuary2026_s, 1);
  int warmest_h = 0, softest_h = 0;
  double most_degc = -100, least = 10;
  for (int h = 0; h < kYear_h; ++h) {
    const double degc = stream.next().outside_degc;
    const double factor = stream.stiffness_factor()[0];
    if (degc > most_degc) most_degc = degc, warmest_h = h;
    if (factor < least) least = factor, softest_h = h;
    EXPECT_DOUBLE_EQ(stream.damping_factor(0), std::pow(factor, -3));
  }
  // A lag of 20 days delays a wave of a year by atan(2 pi 20 / 365) / (2 pi) of it: 19.3 days.
  EXPECT_NEAR((softest_h - warmest_h) / 24.0, 19.3, 0.5);
  EXPECT_NEAR(least, std::exp(-0.01 * 9 * 0.946), 1e-3);
}

TEST(ClimateStream, PeopleMakeAllElementsSofterByTheirMass) {
  Climate c = still();
  c.occupied_mass_ratio = 0.25;
  ClimateStream stream(c, 2, kJanuary2026_s, 1);
  for (int h = 0; h < 24 * 7; ++h) {
    const bool occupied = stream.next().occupied_pct > 0;
    for (const double factor : stream.stiffness_factor())
      EXPECT_DOUBLE_EQ(factor, occupied ? 1 / 1.25 : 1);
  }
}

TEST(ClimateStream, TheSameSeedGivesTheSameHours) {
  ClimateStream a({}, kElements, kJanuary2026_s, 7), b({}, kElements, kJanuary2026_s, 7);
  ClimateStream other({}, kElements, kJanuary2026_s, 8);
  bool differs = false;
  for (int h = 0; h < 1000; ++h) {
    EXPECT_EQ(a.next().outside_degc, b.next().outside_degc);
    EXPECT_EQ(a.stiffness_factor(), b.stiffness_factor());
    other.next();
    differs = differs || other.stiffness_factor() != a.stiffness_factor();
  }
  EXPECT_TRUE(differs);
}

}  // namespace climate_test
}  // namespace framewatch::estimator
