// SPDX-License-Identifier: MIT
// Tests `framewatch history --losses` on a database of 460 days, and the table of its weather.
#include "daemon/monitor/history/history_losses.h"

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/base/clocks.h"
#include "daemon/base/utc_time.h"
#include "daemon/monitor/history/history_command.h"
#include "daemon/monitor/history/summary_store.h"
#include "daemon/monitor/history/weather_table.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace history_losses_test {

constexpr int kDays = 460, kLossDay = 400;
constexpr std::int64_t kFirst_us = 1'735'689'600'000'000;  // 2025-01-01T00:00:00Z
constexpr double kLoss = 0.05, kNoise = 0.004, kPerDegc = 0.001;
const std::vector<std::string> kNames = {"kx_1_y1", "kx_1_y2", "kx_2_y1", "kx_2_y2", "cx_1_y1"};
constexpr std::size_t kLost = 2;

double degc(int day) {
  return 10 - 10 * std::cos(2 * M_PI * day / 365.25);
}

/// A history with one hour a day. The frames follow the temperature; one loses stiffness.
class HistoryLossesTest : public testing::Test {
 protected:
  HistoryLossesTest() {
    HistorySettings settings;
    settings.directory = directory_.path("h");
    settings.summary_s = {3600};
    SummaryStore store(settings);
    EXPECT_EQ(store.open(), "");
    SummaryBatch batch;
    batch.parameters.structure = "four <frames>";
    batch.parameters.name = kNames;
    batch.parameters.unit = {"N/m", "N/m", "N/m", "N/m", "N*s/m"};
    batch.parameters.kind = {0, 0, 0, 0, 2};
    batch.parameters.story = {1, 1, 2, 2, 1};
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    std::string weather = "time,outside_degc\n";
    for (int day = 0; day < kDays; ++day) {
      PeriodData data;
      data.start_us = kFirst_us + day * kDay_us + 12 * 3600 * kSecond_us;
      data.last_us = data.start_us + 1;
      data.windows = 360'000;
      data.parameters.resize(kNames.size());
      for (std::size_t p = 0; p < kNames.size(); ++p) {
        ParameterData& d = data.parameters[p];
        const double left = p == kLost && day >= kLossDay ? 1 - kLoss : 1;
        const double value = 5e8 * left * (1 - kPerDegc * degc(day) + kNoise * normal(random));
        // Windows of 5 s in an hour: the mean's error is that of a window over sqrt(720).
        const double error = kNoise * value * std::sqrt(720);
        d.observable = data.windows;
        d.sum = static_cast<double>(d.observable) * value;
        d.error_squares = static_cast<double>(d.observable) * error * error;
        d.min = d.max = value;
        d.box = {value};
      }
      batch.periods.push_back(data);
      weather += fmt::format("{},{:.2f}\n", utc_text(data.start_us), degc(day));
    }
    EXPECT_EQ(store.add(batch), "");
    test::write_file(weather_path_, weather);
  }

  struct Ran {
    int code;
    std::string out, problems;
  };
  Ran run(HistoryArguments a) const {
    a.place = directory_.path("h");
    a.losses = true;
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int code = history(a);
    return {code, testing::internal::GetCapturedStdout(), testing::internal::GetCapturedStderr()};
  }
  Ran run_with_weather(const std::string& text) const {
    test::write_file(weather_path_, text);
    HistoryArguments a;
    a.weather = weather_path_;
    return run(a);
  }

  const test::TemporaryDirectory directory_;
  const std::string weather_path_ = directory_.path("weather.csv");
};

TEST_F(HistoryLossesTest, NamesTheFrameTheDayAndTheSize) {
  HistoryArguments a;
  a.weather = weather_path_;
  const Ran text = run(a);
  EXPECT_EQ(text.code, 1);
  EXPECT_NE(text.out.find("460 days with values, 2025-01-01 to 2026-04-05; weather: outside_degc"),
            std::string::npos)
      << text.out;
  EXPECT_NE(text.out.find("kx_2_y1 -"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("since 2026-02-05"), std::string::npos) << text.out;
  a.json = true;
  const auto json = nlohmann::json::parse(run(a).out);
  ASSERT_EQ(json["losses"].size(), 1) << json.dump(2);
  const auto& loss = json["losses"][0];
  EXPECT_EQ(loss["parameter"], "kx_2_y1");
  EXPECT_NEAR(loss["ratio"].get<double>(), -kLoss, 4 * loss["std_error"].get<double>());
  EXPECT_EQ(json["elements"].size(), 5);  // no damping, and all alike
}

TEST_F(HistoryLossesTest, TellsAThermometerThatLies) {
  constexpr int kLieDay = 300;
  constexpr double kLie_degc = -12;
  std::string weather = "time,outside_degc\n";
  for (int day = 0; day < kDays; ++day)
    weather += fmt::format("{},{:.2f}\n", utc_text(kFirst_us + day * kDay_us),
                           degc(day) + (day < kLieDay ? 0 : kLie_degc));
  const std::string said = "outside_degc probably reads too low since 2025-10-28, by 1";
  const Ran text = run_with_weather(weather);
  EXPECT_NE(text.out.find(said), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("kx_2_y1 -"), std::string::npos) << text.out;
  HistoryArguments a;
  a.weather = weather_path_;
  a.json = true;
  const auto wrong = nlohmann::json::parse(run(a).out)["wrong_sensor"];
  EXPECT_EQ(wrong["covariate"], "outside_degc");
  EXPECT_NEAR(wrong["reads_too_much"].get<double>(), kLie_degc,
              4 * wrong["std_error"].get<double>());
  a.json = false;
  a.report = directory_.path("report.html");
  (void)run(a);
  EXPECT_NE(test::read_file(a.report).find(said), std::string::npos);
}

TEST_F(HistoryLossesTest, IsSilentBeforeTheLoss) {
  HistoryArguments a;
  a.weather = weather_path_;
  a.to = "2026-02-05";
  const Ran ran = run(a);
  EXPECT_EQ(ran.code, 0) << ran.out;
  EXPECT_NE(ran.out.find("no loss of at least 1 %"), std::string::npos) << ran.out;
}

TEST_F(HistoryLossesTest, DoesWithoutWeather) {
  const Ran ran = run({});
  EXPECT_EQ(ran.code, 1);
  EXPECT_NE(ran.out.find("not known, the season stands for it"), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find("kx_2_y1 -"), std::string::npos) << ran.out;
}

TEST_F(HistoryLossesTest, DrawsEveryFrameDayByDayOnOnePage) {
  HistoryArguments a;
  a.weather = weather_path_;
  a.report = directory_.path("years.html");
  const Ran ran = run(a);
  EXPECT_EQ(ran.code, 1) << ran.problems;
  const std::string page = test::read_file(a.report);
  for (const char* part :
       {"<h1>four &lt;frames&gt;</h1>", "<strong>kx_2_y1 -", "kx_1_y1: 4.9", "loss of 4",
        "outside_degc", "days since 2025-01-01", "windows with values", "There were no events."})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  EXPECT_EQ(page.find("cx_1_y1"), std::string::npos);
}

TEST_F(HistoryLossesTest, SaysThatThereAreNoValues) {
  HistoryArguments a;
  a.parameters = {"cx*"};
  const Ran ran = run(a);
  EXPECT_EQ(ran.code, 0);
  EXPECT_EQ(ran.out,
            "no hour with a value of a frame's stiffness\n"
            "Damping: no growth of at least 11 % that weather does not explain\n");
}

TEST_F(HistoryLossesTest, APageWithoutValuesIsAFailure) {
  HistoryArguments a;
  a.parameters = {"cx*"};
  a.report = directory_.path("years.html");
  const Ran ran = run(a);
  EXPECT_EQ(ran.code, 2);
  EXPECT_EQ(ran.out, "");
  EXPECT_NE(ran.problems.find("years.html was not written: the history has no hour"),
            std::string::npos)
      << ran.problems;
  EXPECT_EQ(test::read_file(a.report), "");
}

TEST_F(HistoryLossesTest, RefusesWhatItCannotCombine) {
  HistoryArguments a;
  a.out = directory_.path("x.csv");
  EXPECT_EQ(run(a).problems,
            "--losses and --report cannot be combined with --out, --raw or --events\n");
  HistoryArguments picture;
  picture.report = directory_.path("years.png");
  EXPECT_EQ(run(picture).code, 2);
  HistoryArguments none;
  none.weather = directory_.path("none.csv");
  const Ran absent = run(none);
  EXPECT_EQ(absent.code, 2);
  EXPECT_NE(absent.problems.find("none.csv"), std::string::npos) << absent.problems;
}

TEST_F(HistoryLossesTest, RefusesAMalformedTableWithEveryProblem) {
  const Ran unit = run_with_weather("time,outside,inside_degc\nyesterday,3,4\n2025-01-01,3,400\n");
  EXPECT_EQ(unit.code, 2);
  EXPECT_EQ(unit.problems, weather_path_ + ":1: \"outside\": the name must end with its unit: " +
                               "_degc, _pct, _mps or _wpm2\n");
  const Ran rows = run_with_weather(
      "time,outside_degc\nyesterday,3\n2025-01-01T00:00Z,285.2\n2025-01-01T00:00Z\n"
      "2025-01-01T00:00Z,warm\n");
  EXPECT_EQ(rows.problems,
            weather_path_ + ":2: \"yesterday\" is not a time such as 2026-11-21T23:15:00Z\n" +
                weather_path_ + ":3: outside_degc: \"285.2\" is not between -60 and 80\n" +
                weather_path_ + ":4: 1 cells, and the header has 2\n" + weather_path_ +
                ":5: outside_degc: \"warm\" is not between -60 and 80\n");
  EXPECT_EQ(run_with_weather("time,outside_degc\n").problems,
            weather_path_ + ": no row with a value\n");
  EXPECT_NE(run_with_weather("date,outside_degc\n").problems.find("the header must be time"),
            std::string::npos);
}

TEST_F(HistoryLossesTest, MeansOfADayLeaveOutEmptyCells) {
  test::write_file(weather_path_,
                   "time,a_degc,b_pct\n2025-01-01T00:00Z,2,\n2025-01-01T12:00Z,4,nan\n"
                   "1735776000,,50\n");
  std::vector<std::string> problems;
  const auto table = read_weather(weather_path_, problems);
  ASSERT_TRUE(table) << problems.front();
  const std::int64_t day = kFirst_us / kDay_us;
  EXPECT_EQ(table->of(day)[0], 3);
  EXPECT_TRUE(std::isnan(table->of(day)[1]));
  EXPECT_TRUE(std::isnan(table->of(day + 1)[0]));
  EXPECT_EQ(table->of(day + 1)[1], 50);
  EXPECT_TRUE(std::isnan(table->of(day + 2)[1]));
}

}  // namespace history_losses_test
}  // namespace framewatch::daemon
