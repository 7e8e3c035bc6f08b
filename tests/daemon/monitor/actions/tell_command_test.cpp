// SPDX-License-Identifier: MIT
#include "daemon/monitor/actions/tell_command.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/config/config.h"
#include "tests/support/recorded_table_test.h"
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
  EXPECT_NE(problems("").find("needs a command or a webhook"), std::string::npos);
  EXPECT_NE(problems("webhook = \"ftp://a\"").find("http://"), std::string::npos);
  EXPECT_NE(problems("webhook = \"https:///a\"").find("must name a host"), std::string::npos);
  EXPECT_NE(problems("webhook = \"https://me:secret@a/\"").find("webhook_header_file"),
            std::string::npos);
  EXPECT_NE(problems("command = [\"a\"]\nwebhook_ca_file = \"b\"").find("needs a webhook"),
            std::string::npos);
  const std::string both = problems("command = [\"\"]\nseverity = \"bad\"\nper_minute = 0");
  EXPECT_NE(both.find("name of a program"), std::string::npos);
  EXPECT_NE(both.find("severity"), std::string::npos);
  EXPECT_NE(both.find("per_minute"), std::string::npos);
}

TEST(Actions, TellReportsWhetherNotificationsWork) {
  const test::TemporaryDirectory directory;
  EXPECT_EQ(tell_command({config_with_actions(directory, "command = [\"true\"]"), "a test"}), 0);
  EXPECT_EQ(tell_command({config_with_actions(directory, "command = [\"false\"]"), "a test"}), 1);
  EXPECT_EQ(tell_command({test::table_config(), "a test"}), 2);
}

}  // namespace tell_command_test
}  // namespace framewatch::daemon
