// SPDX-License-Identifier: MIT
// Tests the report of a month on a history of three months, and its e-mail.
#include "daemon/monitor/history/month_report.h"

#include <random>
#include <string>

#include <gtest/gtest.h>

#include "daemon/base/clocks.h"
#include "daemon/base/utc_time.h"
#include "daemon/monitor/events/event_messages.h"
#include "daemon/monitor/history/summary_store.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace month_report_test {

constexpr int kDays = 91;  // September to November
constexpr int kLossDay = 70;

/// A history with one hour a day. In November one frame loses 10 %.
class MonthReportTest : public testing::Test {
 protected:
  MonthReportTest() {
    config_.history.emplace();
    config_.history->directory = directory_.path("h");
    config_.history->summary_s = {3600};
    config_.pipeline.structure.name = "north <wing>";
    SummaryStore store(*config_.history);
    EXPECT_EQ(store.open(), "");
    SummaryBatch batch;
    batch.parameters.name = {"kx_1_y1", "kx_1_y2", "kx_2_y1", "kx_2_y2"};
    batch.parameters.unit = {"N/m", "N/m", "N/m", "N/m"};
    batch.parameters.kind = {0, 0, 0, 0};
    batch.parameters.story = {1, 1, 2, 2};
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    for (int day = 0; day < kDays; ++day) {
      PeriodData data;
      data.start_us = first_us_ + day * kDay_us + 12 * 3600 * kSecond_us;
      data.last_us = data.start_us + 1;
      data.windows = 360'000;
      data.parameters.resize(4);
      for (std::size_t p = 0; p < 4; ++p) {
        ParameterData& d = data.parameters[p];
        const double value =
            5e8 * (p == 2 && day >= kLossDay ? 0.9 : 1.0) * (1 + 0.002 * normal(random));
        d.observable = data.windows / 4;
        d.sum = static_cast<double>(d.observable) * value;
        d.error_squares = static_cast<double>(d.observable) * 1e-4 * value * value;
        d.min = d.max = value;
        d.box = {value};
      }
      batch.periods.push_back(data);
    }
    event_t e{};
    e.id = 3;
    e.time_us = e.since_us = first_us_ + (kLossDay + 1) * kDay_us;
    e.state = event_state::raised;
    e.severity = severity::alarm;
    e.kind = "stiffness_change";
    e.place = "kx_2_y1";
    e.message = "<b>lost</b>";
    batch.events.push_back(e);
    EXPECT_EQ(store.add(batch), "");
  }

  std::optional<MonthReport> report(int month) {
    return month_report(config_, {}, {2026, month}, first_us_ + kDays * kDay_us, problem_);
  }
  static std::string all(const MonthReport& r) {
    std::string out;
    for (const std::string& sentence : r.sentences) out += sentence + "\n";
    return out;
  }

  const test::TemporaryDirectory directory_;
  const std::int64_t first_us_ = *read_utc("2026-09-01");
  Config config_;
  std::string problem_;
};

TEST(Months, FollowTheCalendar) {
  const Month november = Month::of(*read_utc("2026-11-30T23:59:59Z"));
  EXPECT_EQ(november.name(), "2026-11");
  EXPECT_EQ(november.start_us(), *read_utc("2026-11-01"));
  EXPECT_EQ(november.end_us(), *read_utc("2026-12-01"));
  EXPECT_EQ(november.days(), 30);
  EXPECT_EQ((Month{2027, 1}.before().name()), "2026-12");
  EXPECT_EQ((Month{2028, 2}.days()), 29);
}

TEST_F(MonthReportTest, SaysWhatChangedAndWhatIsHealthy) {
  const auto november = report(11);
  ASSERT_TRUE(november) << problem_;
  EXPECT_TRUE(november->changed);
  const std::string text = all(*november);
  EXPECT_TRUE(text.starts_with("Changed: story 2, frame y1 (kx_2_y1) lost ")) << text;
  for (const char* part :
       {"Healthy: 3 of 4 frames", "values on 30 of 30 days", "in 25 % of the time",
        "Sensors: no samples", "Events: 1 alarms and 0 warnings (1 stiffness_change)", "he disk "})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  for (const char* part : {"<h1>north &lt;wing&gt;, 2026-11</h1>",
                           "<strong>Changed: story 2, frame y1 (kx_2_y1) lost ", "stiffness by day",
                           "&lt;b&gt;lost&lt;/b&gt;"})
    EXPECT_NE(november->page.find(part), std::string::npos) << part;
}

TEST_F(MonthReportTest, WorkOnTheBuildingIsToldAndIsNoLoss) {
  event_t work{};
  work.id = 8;
  work.kind = kMaintenanceKind;
  SummaryBatch batch;
  add_acknowledged(batch.acknowledged.emplace_back(), work,
                   {first_us_ + kLossDay * kDay_us, "alice", "removed <wall>"});
  SummaryStore store(*config_.history);
  ASSERT_EQ(store.open(), "");
  ASSERT_EQ(store.add(batch), "");
  const auto november = report(11);
  ASSERT_TRUE(november) << problem_;
  EXPECT_FALSE(november->changed);
  const std::string text = all(*november);
  for (const char* part : {"Nothing changed this month", "Healthy: 4 of 4",
                           "Changed on purpose on 2026-11-10: removed <wall>",
                           "(1 stiffness_change); 0 acknowledgements"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  EXPECT_NE(november->page.find("removed &lt;wall&gt;"), std::string::npos);
}

TEST_F(MonthReportTest, AQuietMonthIsHealthy) {
  const auto october = report(10);
  ASSERT_TRUE(october) << problem_;
  EXPECT_FALSE(october->changed);
  const std::string text = all(*october);
  EXPECT_TRUE(text.starts_with("Nothing changed this month")) << text;
  EXPECT_NE(text.find("Healthy: 4 of 4"), std::string::npos) << text;
  EXPECT_NE(text.find("Events: none"), std::string::npos) << text;
}

TEST_F(MonthReportTest, AMonthWithoutValuesSaysSo) {
  const auto december = report(12);
  ASSERT_TRUE(december) << problem_;
  EXPECT_NE(all(*december).find("No frame has a value in this month"), std::string::npos)
      << all(*december);
  EXPECT_FALSE(report(8));  // before the history
  EXPECT_EQ(problem_, "");
  config_.history->directory = directory_.path("none");
  EXPECT_FALSE(report(11));
  EXPECT_NE(problem_, "");
}

}  // namespace month_report_test
}  // namespace framewatch::daemon
