// SPDX-License-Identifier: MIT
#include "daemon/monitor/actions/monthly_reports.h"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "daemon/base/clocks.h"
#include "daemon/base/utc_time.h"
#include "daemon/monitor/history/summary_store.h"
#include "tests/daemon/monitor/actions/example_event.h"
#include "tests/support/history_fixture.h"
#include "tests/support/smtp_server.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace monthly_reports_test {

using namespace std::chrono_literals;

constexpr auto kReportSoon = 30s;

class MonthlyReportsTest : public testing::Test {
 protected:
  MonthlyReportsTest() {
    config_.history.emplace();
    config_.history->directory = directory_.path("h");
    config_.history->summary_s = {3600};
    config_.pipeline.structure.name = "north wing";
    config_.report.emplace();
    config_.report->monthly = true;
    config_.report->directory = directory_.path("reports");
    SummaryStore store(*config_.history);
    EXPECT_EQ(store.open(), "");
    SummaryBatch batch;
    batch.parameters.name = {"kx_1_y1"};
    batch.parameters.unit = {"N/m"};
    batch.parameters.kind = {0};
    batch.parameters.story = {1};
    PeriodData data;
    data.start_us = *read_utc("2026-11-10T12:00Z");
    data.last_us = data.start_us + 1;
    data.windows = 1;
    data.parameters.resize(1);
    batch.periods.push_back(data);
    EXPECT_EQ(store.add(batch), "");
  }

  void send_to(const test::SmtpServer& server, std::vector<std::string> people) {
    config_.email.emplace();
    config_.email->server = "127.0.0.1";
    config_.email->port = server.port();
    config_.email->tls = EmailTls::none;
    config_.email->from = "framewatch@example.org";
    config_.report->email = std::move(people);
  }
  std::string make() {
    return make_month_report(config_, {2026, 11}, now_us_, round_, never).trouble;
  }
  std::string file(const std::string& name) const {
    return test::read_file(directory_.path("reports/" + name));
  }

  const test::TemporaryDirectory directory_;
  const std::int64_t now_us_ = *read_utc("2026-12-01T01:00Z");
  Config config_;
  EmailRound round_;
};

TEST_F(MonthlyReportsTest, AreWrittenOnceAnHourAfterTheMonth) {
  MonthlyReports reports;
  reports.configure(config_);
  const auto update = [&](std::int64_t now_us) { reports.update(now_us); };
  update(now_us_ - kSecond_us);  // October: before the history
  EXPECT_TRUE(test::comes_true(
      [&] {
        update(now_us_ - kSecond_us);
        return reports.finished() == "2026-10";
      },
      kReportSoon));
  EXPECT_FALSE(std::filesystem::exists(directory_.path("reports")));
  EXPECT_EQ(reports.done(), 0);
  EXPECT_TRUE(test::comes_true(
      [&] {
        update(now_us_);
        return reports.finished() == "2026-11";
      },
      kReportSoon));
  EXPECT_NE(file("2026-11.html").find("north wing, 2026-11"), std::string::npos);
  test::write_file(directory_.path("reports/2026-11.html"), "kept");
  EXPECT_EQ(make(), "");
  EXPECT_EQ(file("2026-11.html"), "kept");
  EXPECT_EQ(reports.trouble(), "");
  EXPECT_EQ(reports.done(), 1);
}

TEST_F(MonthlyReportsTest, AreSentOnceWithThePage) {
  const test::SmtpServer server;
  send_to(server, {"owner@example.org"});
  EXPECT_EQ(make(), "");
  EXPECT_NE(server.message(1).find("Subject: north wing: 2026-11 report\r\n"), std::string::npos)
      << server.message(1).substr(0, 2000);
  EXPECT_NE(server.message(1).find("filename=\"2026-11.html\""), std::string::npos);
  EXPECT_EQ(file("2026-11.sent"), "sent\n");
  EXPECT_EQ(make(), "");
  EXPECT_EQ(server.message(2), "");
}

TEST_F(MonthlyReportsTest, ADeferredReportIsSentLaterARefusedOneIsNot) {
  const test::SmtpServer server({"--defer", "1", "--refuse", "gone@example.org"});
  send_to(server, {"owner@example.org", "gone@example.org"});
  EXPECT_NE(make().find("450"), std::string::npos);
  EXPECT_EQ(file("2026-11.sent"), "");
  EXPECT_NE(file("2026-11.html"), "");
  EXPECT_EQ(make(), "");
  EXPECT_NE(server.message(1).find("owner@example.org"), std::string::npos);
  EXPECT_TRUE(file("2026-11.sent").starts_with("refused: gone@example.org: "))
      << file("2026-11.sent");
}

TEST_F(MonthlyReportsTest, AMalformedWeatherTableIsNamed) {
  config_.report->weather = directory_.path("weather.csv");
  test::write_file(config_.report->weather, "time,outside\n");
  EXPECT_NE(make().find("the name must end with its unit"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(directory_.path("reports")));
}

}  // namespace monthly_reports_test
}  // namespace framewatch::daemon
