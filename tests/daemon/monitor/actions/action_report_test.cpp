// SPDX-License-Identifier: MIT
// Tests escalation and quiet hours with a mail server and a web server.
#include "daemon/monitor/actions/action_report.h"

#include <string>
#include <vector>

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <lcm/lcm-cpp.hpp>
#include <nlohmann/json.hpp>

#include "daemon/base/clocks.h"
#include "daemon/monitor/events/event_messages.h"
#include "tests/daemon/monitor/actions/example_event.h"
#include "tests/support/history_fixture.h"
#include "tests/support/http_server.h"
#include "tests/support/smtp_server.h"

namespace framewatch::daemon {
namespace action_report_test {

using namespace std::chrono_literals;

constexpr auto kReceivedSoon = 40s;
constexpr double kMoment_min = 0.001;

class ActionReportTest : public testing::Test {
 protected:
  ActionReportTest() {
    config_.pipeline.structure.name = "north wing";
    ActionSettings& s = config_.actions.emplace();
    s.webhook = fmt::format("http://127.0.0.1:{}/", web_.port());
    s.account.server = "127.0.0.1";
    s.account.port = mail_.port();
    s.account.tls = EmailTls::none;
    s.account.from = "framewatch@example.org";
    s.escalate_after_min = kMoment_min;
  }
  /// Returns true if the web server has so many requests soon.
  bool posted(std::size_t requests, ActionReport& report) {
    return test::comes_true(
        [&] {
          report.update(host_clock_us());
          return web_.requests().size() >= requests;
        },
        kReceivedSoon);
  }
  nlohmann::json post(std::size_t at) const {
    return nlohmann::json::parse(web_.requests().at(at).body);
  }

  const test::SmtpServer mail_;
  test::HttpServer web_;
  Config config_;
  lcm::LCM lcm_{"memq://"};
};

TEST_F(ActionReportTest, TheWebhookFollowsWhenNobodyAcknowledgesTheEmail) {
  config_.actions->email = {"owner@example.org"};
  config_.actions->escalate = {"email", "webhook"};
  ActionReport report(config_, "", lcm_);
  report.event(event(1), false);
  report.event(event(2), false);
  EXPECT_TRUE(test::comes_true([&] { return !mail_.message(2).empty(); }, kReceivedSoon));
  EXPECT_TRUE(web_.requests().empty());  // events escalate in update()
  report.acknowledged(event(1));
  ASSERT_TRUE(posted(1, report));
  EXPECT_EQ(post(0)["id"], 2);
  EXPECT_NE(web_.requests()[0].body.find("(not acknowledged for 0.001 min)"), std::string::npos)
      << web_.requests()[0].body;
  // The end goes to those who were told of the event.
  report.event(event(1, event_state::cleared), false);
  report.event(event(2, event_state::cleared), false);
  ASSERT_TRUE(posted(2, report));
  EXPECT_EQ(post(1)["id"], 2);
  EXPECT_EQ(post(1)["state"], "cleared");
  EXPECT_TRUE(test::comes_true([&] { return !mail_.message(4).empty(); }, kReceivedSoon));
  EXPECT_EQ(mail_.message(5), "");
}

TEST_F(ActionReportTest, ReceiversOutsideTheOrderAreToldAtOnce) {
  config_.actions->email = {"owner@example.org"};
  config_.actions->command = {"/bin/true"};
  config_.actions->escalate = {"email", "command"};
  ActionReport report(config_, "", lcm_);
  report.event(event(1), false);
  EXPECT_TRUE(test::comes_true([&] { return web_.requests().size() == 1; }, kReceivedSoon));
}

TEST_F(ActionReportTest, WarningsWaitForTheEndOfQuietHours) {
  const std::int64_t hour = host_clock_us() / (3600 * kSecond_us) % 24;
  config_.actions->time_zone = "UTC";
  config_.actions->quiet_hours =
      fmt::format("{:02}:00-{:02}:00", (hour + 23) % 24, (hour + 2) % 24);
  ActionReport report(config_, "", lcm_);
  report.event(event(1, event_state::raised, severity::warning), false);
  report.event(event(2), false);
  ASSERT_TRUE(posted(1, report));
  EXPECT_EQ(post(0)["id"], 2);
  report.event(event(2, event_state::cleared), false);
  ASSERT_TRUE(posted(2, report));
  EXPECT_EQ(post(1)["id"], 2);
  config_.actions->quiet_hours.clear();
  report.reconfigure(config_);
  ASSERT_TRUE(posted(3, report));
  EXPECT_EQ(post(2)["id"], 1);
}

}  // namespace action_report_test
}  // namespace framewatch::daemon
