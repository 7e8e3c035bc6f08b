// SPDX-License-Identifier: MIT
// Tests how a span of a history becomes some hundreds of points.
#include "daemon/monitor/history/history_points.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/base/clocks.h"
#include "tests/support/stored_summaries.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace history_points_test {

constexpr std::int64_t kDay0_us = 20'000 * kDay_us;  // 2024-10-04
constexpr std::int64_t kDay_s = 86'400, kHour = 3600, kHour_us = kHour * kSecond_us;
constexpr double kAbsurd = 1e12;

class HistoryPoints : public testing::Test {
 protected:
  HistoryPoints() : stored_(directory_.path("h")), id_(stored_.parameter("kx_1_y1")) {}
  void add(std::int64_t period_s, std::int64_t start_us, double value, int observable = 100) {
    stored_.period(period_s, start_us);
    stored_.value(id_, period_s, start_us, value, observable);
  }
  SummaryQuery query() const {
    SummaryQuery out;
    EXPECT_EQ(out.open(directory_.path("h")), "");
    return out;
  }
  HistorySpan span(SummaryQuery& summaries, std::int64_t from_us, std::int64_t to_us) const {
    std::string problem;
    const auto out = choose_span(summaries, from_us, to_us, problem);
    EXPECT_TRUE(out) << problem;
    return out.value_or(HistorySpan{});
  }
  ElementPoints points(SummaryQuery& summaries, const HistorySpan& span) const {
    return element_points({id_, "kx_1_y1", "N/m"}, summaries, span);
  }

  const test::TemporaryDirectory directory_;
  test::StoredSummaries stored_;
  std::int64_t id_;
};

TEST(HistoryStep, FitsTheSpan) {
  const auto step = [](std::int64_t days) {
    return least_step_s(kDay0_us, kDay0_us + days * kDay_us);
  };
  EXPECT_EQ(least_step_s(kDay0_us, kDay0_us + kHour_us), 60);
  EXPECT_EQ(step(1), 600);
  EXPECT_EQ(step(30), kHour);
  EXPECT_EQ(step(31), kHour);
  EXPECT_EQ(step(365), kDay_s);
  EXPECT_EQ(step(3653), 7 * kDay_s);
  for (const std::int64_t days : {1, 5, 6, 31, 32, 700, 751, 5000, 100'000, 50'000'000}) {
    const std::int64_t to_us = kDay0_us + 1 + days * kDay_us;
    const HistorySpan span{kDay0_us + 1, to_us, 60, least_step_s(kDay0_us + 1, to_us), to_us};
    EXPECT_LE(span.points(), HistorySpan::kMostPoints) << days;
    EXPECT_EQ(span.at(span.to_us - 1), span.points() - 1) << days;
  }
}

TEST_F(HistoryPoints, ADayIsTheMedianOfItsHoursAndNothingOutsideOfTheSpanCounts) {
  stored_.together([&] {
    add(kHour, kDay0_us - kHour_us, kAbsurd);
    for (int day = 0; day < 400; ++day) {
      if (day == 7) continue;  // framewatch did not run
      for (const int hour : {0, 6, 12, 18})
        // Half of these hours show it in half of their windows.
        add(kHour, kDay0_us + day * kDay_us + hour * kHour_us,
            day < 365 ? 1000.0 + day + 0.01 * hour : kAbsurd, hour % 12 == 0 ? 50 : 0);
    }
  });
  SummaryQuery summaries = query();
  const HistorySpan year = span(summaries, kDay0_us, kDay0_us + 365 * kDay_us);
  EXPECT_EQ(year.period_s, kHour);
  EXPECT_EQ(year.step_s, kDay_s);
  ASSERT_EQ(year.points(), 365u);
  const ElementPoints p = points(summaries, year);
  for (std::size_t day = 0; day < 365; ++day) {
    if (day == 7) {
      EXPECT_TRUE(std::isnan(p.median[day]));
      EXPECT_EQ(p.covered[day], 0);
      continue;
    }
    const double median = 1000.0 + static_cast<double>(day) + 0.12;
    EXPECT_NEAR(p.median[day], median, 1e-9) << day;
    EXPECT_NEAR(p.q1[day], 0.99 * median, 1e-9) << day;
    EXPECT_NEAR(p.q3[day], 1.01 * median, 1e-9) << day;
    // The newest summary of the span ends at 19:00.
    EXPECT_NEAR(p.covered[day], day == 364 ? 1.0 / 19 : 1.0 / 24, 1e-9) << day;
  }
  EXPECT_EQ(summaries.problem(), "");
}

TEST_F(HistoryPoints, TheNewestStepIsCoveredAsFarAsItHasCome) {
  for (int hour = 0; hour < 6; ++hour) add(kHour, kDay0_us + hour * kHour_us, 1000);
  SummaryQuery summaries = query();
  const HistorySpan year = span(summaries, kDay0_us - 363 * kDay_us, kDay0_us + 2 * kDay_us);
  const ElementPoints p = points(summaries, year);
  EXPECT_EQ(p.covered[362], 0);
  EXPECT_NEAR(p.covered[363], 1, 1e-9);
  EXPECT_TRUE(std::isnan(p.covered[364])) << "a day that has not come";
}

TEST_F(HistoryPoints, TheLongestSummariesThatTheStepAllowsAreRead) {
  stored_.together([&] {
    for (int minute = 0; minute < 1440; ++minute)
      if (minute >= 720) add(60, kDay0_us + minute * 60 * kSecond_us, 1);
    for (int part = 0; part < 144; ++part) add(600, kDay0_us + part * 600 * kSecond_us, 2);
    for (int hour = 0; hour < 24; ++hour) add(kHour, kDay0_us + hour * kHour_us, 3);
  });
  SummaryQuery summaries = query();
  EXPECT_EQ(summaries.period_lengths(), (std::vector<std::int64_t>{60, 600, kHour}));
  EXPECT_EQ(span(summaries, kDay0_us, kDay0_us + kDay_us).period_s, 600);
  EXPECT_EQ(span(summaries, kDay0_us, kDay0_us + 30 * kDay_us).period_s, kHour);
  EXPECT_EQ(span(summaries, kDay0_us + 20 * kHour_us, kDay0_us + 24 * kHour_us).period_s, 60);
  // The minutes of the first hours are deleted: longer summaries stand for them.
  const HistorySpan early = span(summaries, kDay0_us, kDay0_us + 12 * kHour_us + 1);
  EXPECT_EQ(early.period_s, 600);
  EXPECT_EQ(early.step_s, 600);
  EXPECT_EQ(points(summaries, early).median[3], 2);
  const HistorySpan none = span(summaries, kDay0_us + 2 * kDay_us, kDay0_us + 3 * kDay_us);
  EXPECT_EQ(none.period_s, 0);
  EXPECT_TRUE(std::isnan(points(summaries, none).median[0]));
}

TEST_F(HistoryPoints, ASpanThatWouldReadTooMuchIsRefused) {
  add(60, kDay0_us, 1);
  SummaryQuery summaries = query();
  std::string problem;
  EXPECT_TRUE(choose_span(summaries, kDay0_us, kDay0_us + 277 * kDay_us, problem));
  EXPECT_FALSE(choose_span(summaries, kDay0_us, kDay0_us + 278 * kDay_us, problem));
  EXPECT_EQ(problem,
            "the span is too long for its summaries of 60 s: ask for at most 278 days at once");
}

TEST_F(HistoryPoints, TheExtentSkipsAClockThatWasNotSet) {
  SummaryQuery empty = query();
  EXPECT_FALSE(history_extent(empty));
  add(kHour, 0, 1);
  for (int hour = 0; hour < 3; ++hour) add(kHour, kDay0_us + hour * kHour_us, 1);
  add(60, kDay0_us + 2 * kHour_us + 60 * kSecond_us, 1);
  SummaryQuery summaries = query();
  const auto all = history_extent(summaries);
  ASSERT_TRUE(all);
  EXPECT_EQ(all->first_us, kDay0_us);
  EXPECT_EQ(all->end_us, kDay0_us + 2 * kHour_us + 120 * kSecond_us) << "the hour is still open";
}

TEST_F(HistoryPoints, WeatherIsAveragedOverLongStepsAndCarriedOverShortOnes) {
  stored_.together([&] {
    for (int hour = 0; hour < 48; ++hour)
      if (hour != 5) stored_.weather("outside_degc", kDay0_us + hour * kHour_us, hour);
    stored_.weather("wind_mps", kDay0_us - kDay_us, 3);
    for (int part = 0; part < 12; ++part) add(600, kDay0_us + part * 600 * kSecond_us, 2);
    add(kHour, kDay0_us, 2);
  });
  SummaryQuery summaries = query();
  const HistorySpan year = span(summaries, kDay0_us, kDay0_us + 365 * kDay_us);
  const auto by_day = weather_points(summaries, year);
  ASSERT_EQ(by_day.size(), 1u) << "no hour of wind is in the span";
  EXPECT_EQ(by_day[0].name, "outside_degc");
  EXPECT_NEAR(by_day[0].mean[0], (276.0 - 5) / 23, 1e-9);
  EXPECT_EQ(by_day[0].min[0], -1);
  EXPECT_EQ(by_day[0].max[1], 48);
  EXPECT_TRUE(std::isnan(by_day[0].mean[2]));
  const auto by_part =
      weather_points(summaries, span(summaries, kDay0_us + 1800 * kSecond_us, kDay0_us + kDay_us));
  EXPECT_EQ(by_part[0].mean[2], 0);
  EXPECT_EQ(by_part[0].mean[3], 1);
  EXPECT_EQ(by_part[0].mean[8], 1);
  EXPECT_TRUE(std::isnan(by_part[0].mean[30])) << "no reading in that hour";
}

TEST(HistoryCorrection, TakesOutWhatTheWeatherDoes) {
  WeatherEffects effects;
  for (int day = 0; day < 14; ++day)
    effects.weather[20'000 + day] = Eigen::Vector2d(1, day % 2 == 0 ? 1 : -1);
  effects.by_element["kx_1_y1"] = Eigen::Vector2d(0, 0.02);
  effects.find_mean();
  const std::int64_t to_us = kDay0_us + 14 * kDay_us;
  const HistorySpan days{kDay0_us, to_us, kHour, kDay_s, to_us};
  ElementPoints points;
  for (int day = 0; day < 14; ++day)
    points.median.push_back(1000 * std::exp(day % 2 == 0 ? 0.02 : -0.02));
  points.median[4] = NAN;
  const auto corrected = corrected_points("kx_1_y1", points, days, effects);
  for (std::size_t day = 0; day < 14; ++day)
    if (day == 4)
      EXPECT_TRUE(std::isnan(corrected[day]));
    else
      EXPECT_NEAR(corrected[day], 1000, 1e-9) << day;
  EXPECT_TRUE(std::isnan(corrected_points("Gk_1_x1y1", points, days, effects)[0]));
}

}  // namespace history_points_test
}  // namespace framewatch::daemon
