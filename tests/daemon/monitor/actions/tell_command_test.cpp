// SPDX-License-Identifier: MIT
#include "daemon/monitor/actions/tell_command.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/config/config.h"
#include "tests/support/http_server.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/smtp_server.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace tell_command_test {

std::string config_with_actions(const test::TemporaryDirectory& directory,
                                const std::string& keys) {
  const std::string path = directory.path("table.toml");
  test::write_file(path, test::read_file(test::table_config()) + "\n[actions]\n" + keys);
  return path;
}

TEST(Actions, ReportProblemsOfTheConfigurationAtOnce) {
  const test::TemporaryDirectory directory;
  const auto problems = [&](const std::string& keys) {
    std::vector<ConfigProblem> found;
    EXPECT_FALSE(load_config(config_with_actions(directory, keys), found));
    std::string all;
    for (const ConfigProblem& p : found) all += p.where + ": " + p.message + "\n";
    return all;
  };
  EXPECT_NE(problems("").find("needs a command, a webhook or an email"), std::string::npos);
  EXPECT_NE(problems("webhook = \"ftp://a\"").find("http://"), std::string::npos);
  EXPECT_NE(problems("webhook = \"https:///a\"").find("must name a host"), std::string::npos);
  EXPECT_NE(problems("webhook = \"https://me:secret@a/\"").find("webhook_header_file"),
            std::string::npos);
  EXPECT_NE(problems("command = [\"a\"]\nwebhook_ca_file = \"b\"").find("needs a webhook"),
            std::string::npos);
  EXPECT_NE(problems("webhook = \"http://a\"\nwebhook_format = \"teems\"").find("pagerduty"),
            std::string::npos);
  EXPECT_NE(problems("webhook_format = \"pagerduty\"").find("needs webhook_key_file"),
            std::string::npos);
  EXPECT_NE(problems("webhook = \"https://ntfy.sh\"\nwebhook_format = \"ntfy\"").find("topic"),
            std::string::npos);
  EXPECT_NE(problems("command = [\"a\"]\nwebhook_format = \"slack\"").find("needs a webhook"),
            std::string::npos);
  EXPECT_NE(problems("webhook = \"http://a\"\nwebhook_file = \"b\"").find("cannot be combined"),
            std::string::npos);
  const std::string people = problems("email = [\"Jo <jo@example.org>\", \"jo\"]");
  EXPECT_NE(people.find("\"jo\" must be an address"), std::string::npos) << people;
  EXPECT_NE(people.find("without a name"), std::string::npos) << people;
  EXPECT_NE(people.find("needs a section [email]"), std::string::npos) << people;
  const std::string account = problems(
      "email = [\"jo@example.org\"]\n[email]\nserver = \"mail:25\"\nfrom = \"me\"\ntls = "
      "\"none\"\nlogin_file = \"a\"\npassword = \"secret\"");
  for (const char* rule : {"without a port", "owner@example.org", "starttls", "password"})
    EXPECT_NE(account.find(rule), std::string::npos) << rule << "\n" << account;
  EXPECT_EQ(account.find("secret"), std::string::npos) << account;
  const std::string times = problems(
      "command = [\"a\"]\nquiet_hours = \"22-7\"\nwell_at = \"8\"\ntime_zone = "
      "\"Europe/Atlantis\"");
  for (const char* rule : {"two different times", "must be a time,", "time zone that this machine"})
    EXPECT_NE(times.find(rule), std::string::npos) << rule << "\n" << times;
  EXPECT_NE(problems("command = [\"a\"]\nwell_at = \"08:00\"").find("needs time_zone"),
            std::string::npos);
  EXPECT_NE(problems("command = [\"a\"]\nwell_at = \"23:00\"\nquiet_hours = "
                     "\"22:00-07:00\"\ntime_zone = \"UTC\"")
                .find("within quiet_hours"),
            std::string::npos);
  const std::string order =
      problems("command = [\"a\"]\nescalate = [\"command\", \"email\", \"command\", \"pigeon\"]");
  for (const char* rule :
       {"\"email\" is not configured", "\"command\" is there twice", "\"pigeon\" is not command"})
    EXPECT_NE(order.find(rule), std::string::npos) << rule << "\n" << order;
  const std::string both = problems("command = [\"\"]\nseverity = \"bad\"\nper_minute = 0");
  EXPECT_NE(both.find("name of a program"), std::string::npos);
  EXPECT_NE(both.find("severity"), std::string::npos);
  EXPECT_NE(both.find("per_minute"), std::string::npos);
}

struct Told {
  int code;
  std::string out;
};
Told tell(const test::TemporaryDirectory& directory, const std::string& keys) {
  testing::internal::CaptureStdout();
  const int code = tell_command({config_with_actions(directory, keys), "a test"});
  return {code, testing::internal::GetCapturedStdout()};
}

TEST(Actions, TellReportsWhetherNotificationsWork) {
  const test::TemporaryDirectory directory;
  EXPECT_EQ(tell(directory, "command = [\"true\"]").code, 0);
  const Told failed = tell(directory, "command = [\"false\"]");
  EXPECT_EQ(failed.code, 1);
  EXPECT_EQ(failed.out, "command  false: exit status 1\n");
  EXPECT_EQ(tell_command({test::table_config(), "a test"}), 2);
}

TEST(Actions, TellTriesEachReceiverAndSaysWhatItAnswered) {
  const test::TemporaryDirectory directory;
  const test::SmtpServer mail({"--refuse", "gone@example.org"});
  test::HttpServer server;
  server.say("ok");
  const std::string account =
      "\nemail = [\"gone@example.org\", \"jo@example.org\"]\n[email]\nserver = "
      "\"127.0.0.1\"\ntls = \"none\"\nfrom = \"framewatch@example.org\"\nport = " +
      std::to_string(mail.port());
  const Told told = tell(directory,
                         "command = [\"false\"]\nwebhook_format = \"slack\"\nwebhook = "
                         "\"http://127.0.0.1:" +
                             std::to_string(server.port()) + "/\"" + account);
  EXPECT_EQ(told.code, 1);
  EXPECT_TRUE(
      told.out.starts_with("command  false: exit status 1\n"
                           "webhook  delivered, answer: 200 (ok)\n"
                           "email    gone@example.org: "))
      << told.out;
  EXPECT_NE(told.out.find("550 5.1.1 no such user"), std::string::npos) << told.out;
  EXPECT_TRUE(
      told.out.ends_with("email    jo@example.org: delivered, answer: 250 2.0.0 queued as 1\n"))
      << told.out;
  EXPECT_EQ(nlohmann::json::parse(server.requests().front().body).count("blocks"), 1u);
}

TEST(Actions, TellLeavesNoIncidentOpen) {
  const test::TemporaryDirectory directory;
  test::write_file(directory.path("key"), "abc\n");
  test::HttpServer server;
  server.answer({202});
  const Told told = tell(directory,
                         "webhook_format = \"pagerduty\"\nwebhook_key_file = \"key\"\n"
                         "webhook = \"http://127.0.0.1:" +
                             std::to_string(server.port()) + "/v2/enqueue\"");
  EXPECT_EQ(told.code, 0) << told.out;
  ASSERT_EQ(server.requests().size(), 2u);
  const auto opened = nlohmann::json::parse(server.requests()[0].body);
  const auto resolved = nlohmann::json::parse(server.requests()[1].body);
  EXPECT_EQ(opened["event_action"], "trigger");
  EXPECT_EQ(resolved["event_action"], "resolve");
  EXPECT_EQ(opened["dedup_key"], resolved["dedup_key"]);
}

}  // namespace tell_command_test
}  // namespace framewatch::daemon
