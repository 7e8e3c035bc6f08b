// SPDX-License-Identifier: MIT
// Tests the weather that a history keeps, and the watch of years that follows a growing history.
#include <chrono>
#include <cmath>
#include <filesystem>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "daemon/base/clocks.h"
#include "daemon/base/sqlite_file.h"
#include "daemon/monitor/events/event_messages.h"
#include "daemon/monitor/history/history_command.h"
#include "daemon/monitor/history/history_files.h"
#include "daemon/monitor/history/history_losses.h"
#include "daemon/monitor/history/history_schema.h"
#include "daemon/monitor/history/loss_follower.h"
#include "daemon/monitor/history/loss_monitor.h"
#include "daemon/monitor/history/summary_query.h"
#include "daemon/monitor/history/summary_store.h"
#include "daemon/monitor/history/weather_table.h"
#include "tests/support/history_fixture.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace weather_history_test {

constexpr int kDays = 300, kLossDay = 200;
constexpr std::int64_t kFirstDay = 20'089;  // 2025-01-01
constexpr double kLoss = 0.05, kNoise = 0.004, kPerDegc = 0.001;
const std::vector<std::string> kNames = {"kx_1_y1", "kx_1_y2", "kx_2_y1", "kx_2_y2", "cx_1_y1"};
constexpr std::size_t kLost = 2;

double degc(std::int64_t day) {
  return 10 - 10 * std::cos(2 * M_PI * static_cast<double>(day - kFirstDay) / 365.25);
}

/// Makes the hour of a day in which the building showed its stiffness, and two readings of weather.
SummaryBatch batch_of(std::int64_t day, bool damaged) {
  SummaryBatch out;
  out.parameters.structure = "four frames";
  out.parameters.name = kNames;
  out.parameters.unit = {"N/m", "N/m", "N/m", "N/m", "N*s/m"};
  out.parameters.kind = {0, 0, 0, 0, 2};
  out.parameters.story = {1, 1, 2, 2, 1};
  std::mt19937_64 random(static_cast<std::uint64_t>(day));
  std::normal_distribution<double> normal;
  PeriodData data;
  data.start_us = day * kDay_us + 12 * kHour_s * kSecond_us;
  data.last_us = data.start_us + 1;
  data.windows = 360'000;
  data.parameters.resize(kNames.size());
  for (std::size_t p = 0; p < kNames.size(); ++p) {
    ParameterData& d = data.parameters[p];
    const double left = damaged && p == kLost && day >= kFirstDay + kLossDay ? 1 - kLoss : 1;
    const double value = 5e8 * left * (1 - kPerDegc * degc(day) + kNoise * normal(random));
    const double error = kNoise * value * std::sqrt(720);
    d.observable = data.windows;
    d.sum = static_cast<double>(d.observable) * value;
    d.error_squares = static_cast<double>(d.observable) * error * error;
    d.min = d.max = value;
    d.box = {value};
  }
  out.periods.push_back(data);
  for (const double off : {-1.0, 1.0})
    out.weather.push_back(
        {"outside_degc", data.start_us + static_cast<std::int64_t>(off + 2), degc(day) + off});
  return out;
}

class WeatherHistory : public testing::Test {
 protected:
  WeatherHistory() : config_(test::table_with_history(directory_.path("h"))) {
    config_.history->summary_s = {kHour_s};
    config_.watch.emplace();
  }
  void write(int from, int to, bool damaged = true) {
    SummaryStore store(*config_.history);
    ASSERT_EQ(store.open(), "");
    for (int day = from; day < to; ++day)
      ASSERT_EQ(store.add(batch_of(kFirstDay + day, damaged)), "");
  }
  SummaryQuery query() const {
    SummaryQuery out;
    EXPECT_EQ(out.open(config_.history->directory), "");
    return out;
  }
  LossFollower follower() const {
    return {Quantity::stiffness, config_.watch->life, config_.pipeline.options.window_s, kHour_s};
  }
  std::vector<LossFollower::Loss> advance(LossFollower& follower, int days) const {
    SummaryQuery summaries = query();
    std::string problem;
    auto out = follower.advance(
        summaries, kFirstDay + days, [] { return false; }, problem);
    EXPECT_TRUE(out) << problem;
    return out.value_or(std::vector<LossFollower::Loss>{});
  }
  /// Returns what find_losses() finds in the whole history.
  HistoryLosses all_losses() const {
    SummaryQuery summaries = query();
    HistoryRequest request;
    request.config = config_;
    request.parameters = summaries.parameters();
    const std::vector<ElementDays> days = read_days(request, Quantity::stiffness, summaries);
    return find_losses(Quantity::stiffness, days,
                       weather_of(summaries.weather(-kEver_us, kEver_us), {"outside_degc"}),
                       config_.watch->life, summaries.maintenance_days());
  }
  /// Tells that the building was changed on purpose at noon of a day, or only notes something.
  void note(int day, const char* kind) {
    SummaryStore store(*config_.history);
    ASSERT_EQ(store.open(), "");
    event_t event{};
    event.id = day;
    event.kind = kind;
    SummaryBatch batch;
    add_acknowledged(batch.acknowledged.emplace_back(), event,
                     {(kFirstDay + day) * kDay_us + kDay_us / 2, "alice", "a wall"});
    ASSERT_EQ(store.add(batch), "");
  }

  const test::TemporaryDirectory directory_;
  Config config_;
};

TEST_F(WeatherHistory, KeepsTheMeanOfEveryHourOnce) {
  write(0, 2);
  write(0, 2);  // the same readings again, as after a restart
  SummaryQuery summaries = query();
  const auto hours = summaries.weather(-kEver_us, kEver_us);
  ASSERT_EQ(hours.size(), 2u);
  EXPECT_EQ(hours[0].name, "outside_degc");
  EXPECT_EQ(hours[0].start_us, kFirstDay * kDay_us + 12 * kHour_s * kSecond_us);
  EXPECT_EQ(hours[0].readings, 2);
  EXPECT_NEAR(hours[0].mean, degc(kFirstDay), 1e-9);
  EXPECT_NEAR(hours[0].min, degc(kFirstDay) - 1, 1e-9);
  EXPECT_NEAR(hours[0].max, degc(kFirstDay) + 1, 1e-9);
  const auto spans = summaries.weather_spans();
  ASSERT_EQ(spans.size(), 1u);
  EXPECT_EQ(spans[0].first_us, hours[0].start_us);
  EXPECT_EQ(spans[0].last_us, hours[1].start_us);
}

TEST_F(WeatherHistory, ReadsADatabaseOfTheVersionBefore) {
  const std::string path = summary_file(directory_.path("old"));
  std::filesystem::create_directory(directory_.path("old"));
  {
    SqliteFile file;
    ASSERT_TRUE(file.open(path));
    ASSERT_EQ(upgrade(file, history_schema().first(2)), "");
  }
  SummaryQuery summaries;
  ASSERT_EQ(summaries.open(directory_.path("old")), "");
  EXPECT_TRUE(summaries.weather(-kEver_us, kEver_us).empty());
  EXPECT_TRUE(summaries.parameters().empty());
  EXPECT_EQ(summaries.problem(), "");
  HistorySettings settings = *config_.history;
  settings.directory = directory_.path("old");
  SummaryStore store(settings);
  ASSERT_EQ(store.open(), "");  // and it is upgraded
  EXPECT_EQ(store.add(batch_of(kFirstDay, false)), "");
}

TEST_F(WeatherHistory, IsExportedAsATableThatReadsBack) {
  write(0, 3);
  HistoryArguments a;
  a.place = config_.history->directory;
  a.weather_out = directory_.path("w.csv");
  ASSERT_EQ(history(a), 0);
  std::vector<std::string> problems;
  const auto table = read_weather(a.weather_out, problems);
  ASSERT_TRUE(table);
  EXPECT_EQ(table->covariates[0].name, "outside_degc");
  for (int day = 0; day < 3; ++day)
    EXPECT_NEAR(table->of(kFirstDay + day)[0], degc(kFirstDay + day), 1e-9);
  a.weather_out = directory_.path("w.txt");
  EXPECT_EQ(history(a), 2);
}

TEST_F(WeatherHistory, LossesUseTheKeptWeather) {
  write(0, kDays);
  HistoryArguments a;
  a.place = config_.history->directory;
  a.losses = true;
  testing::internal::CaptureStdout();
  EXPECT_EQ(history(a), 1);
  const std::string out = testing::internal::GetCapturedStdout();
  EXPECT_NE(out.find("weather: outside_degc"), std::string::npos) << out;
  EXPECT_NE(out.find("kx_2_y1 -"), std::string::npos) << out;
}

TEST_F(WeatherHistory, ACovariateThatCameLateOrWentAwayIsLeftOut) {
  const auto us = [](int day) { return (kFirstDay + day) * kDay_us; };
  const std::vector<WeatherSpan> spans = {{"kept_degc", us(0), us(2499)},
                                          {"late_degc", us(600), us(2499)},
                                          {"gone_degc", us(0), us(1500)},
                                          {"first_degc", us(20), us(2499)}};
  const auto kept = lasting_covariates(spans, kFirstDay, kFirstDay + 2000);
  ASSERT_EQ(kept.size(), 2u);
  EXPECT_EQ(kept[0].name, "kept_degc");
  EXPECT_EQ(kept[1].name, "first_degc");
  EXPECT_EQ(lasting_covariates(spans, kFirstDay, kFirstDay + 2500).size(), 3u);
}

TEST_F(WeatherHistory, FollowingDayByDayFindsWhatAllDaysTogetherShow) {
  write(0, kDays);
  const HistoryLosses all = all_losses();
  ASSERT_EQ(all.found.size(), 1u);
  LossFollower by_day = follower(), at_once = follower();
  std::vector<LossFollower::Loss> found;
  for (int day = 150; day <= kDays; ++day)
    for (LossFollower::Loss& loss : advance(by_day, day)) found.push_back(std::move(loss));
  auto whole = advance(at_once, kDays);
  for (const auto* losses : {&found, &whole}) {
    ASSERT_EQ(losses->size(), 1u);
    const LossFollower::Loss& loss = losses->front();
    EXPECT_EQ(loss.element, "kx_2_y1");
    EXPECT_EQ(loss.finding.found_day, all.found[0].found_day);
    EXPECT_EQ(loss.finding.since_day, all.found[0].since_day);
    EXPECT_EQ(loss.finding.ratio, all.found[0].ratio);
    EXPECT_EQ(loss.finding.std_error, all.found[0].std_error);
  }
  EXPECT_EQ(by_day.days(), kDays);
  EXPECT_TRUE(advance(by_day, kDays).empty());
}

TEST_F(WeatherHistory, WhatFollowsTheWeatherIsTakenOutOfAValueAndALossIsNot) {
  write(0, kDays);
  LossFollower f = follower();
  f.keep_weather();
  EXPECT_TRUE(f.weather_effects().empty());
  advance(f, kDays);
  const WeatherEffects effects = f.weather_effects();
  ASSERT_FALSE(effects.empty());
  EXPECT_EQ(effects.covariates, std::vector<std::string>{"outside_degc"});
  EXPECT_EQ(effects.weather.size(), static_cast<std::size_t>(kDays));
  EXPECT_TRUE(effects.knows("kx_2_y2"));
  EXPECT_FALSE(effects.knows("cx_1_y1"));
  const auto noon = [](int day) { return (kFirstDay + day) * kDay_us + kDay_us / 2; };
  for (const char* name : {"kx_1_y1", "kx_2_y1"}) {
    const double summer = effects.at(name, noon(182)), winter = effects.at(name, noon(5));
    EXPECT_NEAR(summer - winter, -kPerDegc * (degc(kFirstDay + 182) - degc(kFirstDay + 5)), 0.004);
    // Between two noons lies what is between their values.
    EXPECT_NEAR(effects.at(name, noon(90) + kDay_us / 4),
                0.75 * effects.at(name, noon(90)) + 0.25 * effects.at(name, noon(91)), 1e-12);
    EXPECT_NEAR(effects.over(name, noon(90) - kDay_us / 2, noon(92) - kDay_us / 2),
                (effects.at(name, noon(90)) + effects.at(name, noon(91))) / 2, 1e-12);
    EXPECT_EQ(effects.at(name, noon(kDays) - 1), effects.at(name, noon(kDays - 1)));
    EXPECT_TRUE(std::isnan(effects.at(name, noon(kDays + 1))));
    EXPECT_TRUE(std::isnan(effects.at(name, noon(-2))));
  }
  EXPECT_TRUE(std::isnan(effects.at("cx_1_y1", noon(10))));
  LossFollower without = follower();
  advance(without, kDays);
  EXPECT_TRUE(without.weather_effects().empty());
}

TEST_F(WeatherHistory, AHealthyBuildingHasNoLoss) {
  write(0, kDays, false);
  LossFollower f = follower();
  EXPECT_TRUE(advance(f, kDays).empty());
}

TEST_F(WeatherHistory, MaintenanceIsNoLossWheneverItIsTold) {
  write(0, kDays);
  note(kLossDay, kNoteKind);
  EXPECT_EQ(all_losses().found.size(), 1u);  // a remark changes nothing
  LossFollower late = follower();
  EXPECT_EQ(advance(late, kDays).size(), 1u);
  note(kLossDay, kMaintenanceKind);
  const HistoryLosses all = all_losses();
  EXPECT_TRUE(all.found.empty());
  EXPECT_EQ(all.maintenance_days, std::vector<std::int64_t>{kFirstDay + kLossDay});
  EXPECT_NE(losses_text(all).find("changed on purpose on 2025-07-20"), std::string::npos)
      << losses_text(all);
  EXPECT_NE(losses_json(all, {}).find("2025-07-20"), std::string::npos);
  LossFollower early = follower();
  EXPECT_TRUE(advance(early, kDays).empty());
  EXPECT_TRUE(advance(late, kDays).empty());
  EXPECT_EQ(late.days(), early.days());
}

TEST_F(WeatherHistory, FollowsBackAfterAClockThatWasAhead) {
  write(0, 100, false);
  LossFollower f = follower();
  EXPECT_TRUE(advance(f, 20'000).empty());
  write(100, kDays);
  const auto found = advance(f, kDays);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].element, "kx_2_y1");
}

TEST_F(WeatherHistory, ADayOfAClockThatWasNotSetDoesNotCost) {
  {
    SummaryStore store(*config_.history);
    ASSERT_EQ(store.open(), "");
    SummaryBatch batch = batch_of(0, false);
    batch.weather.clear();
    ASSERT_EQ(store.add(batch), "");
  }
  write(0, kDays);
  LossFollower f = follower();
  const auto found = advance(f, kDays);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(f.days(), kDays);
}

TEST_F(WeatherHistory, StopsAndSaysWhatItCannotRead) {
  write(0, 10, false);
  LossFollower f = follower();
  SummaryQuery summaries = query();
  std::string problem;
  EXPECT_FALSE(f.advance(
      summaries, kFirstDay + 10, [] { return true; }, problem));
  EXPECT_EQ(problem, "");
  EXPECT_TRUE(advance(f, 10).empty());
  EXPECT_EQ(f.days(), 10);
}

TEST(LossEvent, OfDampingIsAWarningAboutItsPlace) {
  const LossFollower::Loss grown{"cx_2_y1", {2, 20'000, 19'990, 0.31, 0.04}};
  const event_t event = loss_event(Quantity::damping, grown, {}, {});
  EXPECT_EQ(event.kind, "lasting_damping");
  EXPECT_EQ(event.severity, severity::warning);
  EXPECT_EQ(event.place, "cx_2_y1");
  EXPECT_DOUBLE_EQ(event.value, 31);
  EXPECT_EQ(event.message.rfind("the damping of story 2, frame y1 (cx_2_y1) grew by ", 0), 0u)
      << event.message;
  const event_t loss = loss_event(Quantity::stiffness, {"kx_2_y1", grown.finding}, {}, {});
  EXPECT_NE(event.id, loss.id);
}

/// Waits for the news of a monitor.
LossMonitor::News news_of(LossMonitor& monitor, std::int64_t stored_us) {
  LossMonitor::News out;
  (void)test::comes_true(
      [&] {
        LossMonitor::News news = monitor.update(stored_us);
        for (event_t& e : news.events) out.events.push_back(std::move(e));
        if (!news.before.all().empty()) out.before = std::move(news.before);
        out.problem = std::move(news.problem);
        return !out.events.empty() || !out.before.all().empty();
      },
      std::chrono::seconds(60));
  return out;
}

TEST_F(WeatherHistory, AnEventTellsALossOnceAndOutlivesARestart) {
  write(0, kDays);
  const std::int64_t stored_us = (kFirstDay + kDays) * kDay_us + 2 * LossMonitor::kMargin_us;
  event_t event{};
  {
    LossMonitor monitor(config_);
    LossMonitor::News news = news_of(monitor, stored_us);
    ASSERT_EQ(news.events.size(), 1u) << news.problem;
    event = news.events[0];
  }
  EXPECT_EQ(event.kind, "lasting_loss");
  EXPECT_EQ(event.place, "kx_2_y1");
  EXPECT_EQ(event.state, event_state::raised);
  EXPECT_EQ(event.severity, severity::alarm);
  EXPECT_EQ(event.unit, "%");
  EXPECT_NEAR(event.value, -100 * kLoss, 4 * event.std_error);
  EXPECT_NEAR(static_cast<double>(event.since_us),
              static_cast<double>((kFirstDay + kLossDay) * kDay_us), 3e6 * 86400);
  EXPECT_NE(event.message.find("story 2, frame y1 (kx_2_y1) lost "), std::string::npos)
      << event.message;
  EXPECT_NE(event.message.find("Chance of a false one in 30 years: 5 %"), std::string::npos)
      << event.message;
  {
    SummaryStore store(*config_.history);
    ASSERT_EQ(store.open(), "");
    SummaryBatch batch;
    batch.events.push_back(event);
    acknowledged_t by{};
    add_acknowledged(by, event, {stored_us, "Jo", "seen"});
    batch.acknowledged.push_back(by);
    ASSERT_EQ(store.add(batch), "");
  }
  LossMonitor again(config_);
  LossMonitor::News news = news_of(again, stored_us);
  EXPECT_TRUE(news.events.empty());
  ASSERT_EQ(news.before.all().size(), 1u);
  EXPECT_EQ(news.before.all()[0].id, event.id);
  ASSERT_NE(news.before.acknowledgement(event.id), nullptr);
  EXPECT_EQ(news.before.acknowledgement(event.id)->who, "Jo");
}

}  // namespace weather_history_test
}  // namespace framewatch::daemon
