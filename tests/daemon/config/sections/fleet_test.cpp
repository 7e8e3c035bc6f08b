// SPDX-License-Identifier: MIT
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/config_fixture.h"

namespace framewatch::daemon {
namespace fleet_test {

const std::string kFleet = std::string(test::kGoodConfig) +
                           "[history]\ndirectory = \"h\"\n"
                           "[fleet]\n"
                           "building = \"kobe-03\"\n"
                           "hubs = [\"tls://hub1.example.org:4222\", \"tls://10.0.0.2:4222\"]\n"
                           "certificate = \"c.pem\"\n"
                           "key = \"c.key\"\n"
                           "ca = \"ca.pem\"\n";

std::string problems_of(const std::string& text) {
  std::vector<ConfigProblem> problems;
  EXPECT_FALSE(parse_config("c.toml", text, problems));
  return test::told(problems);
}

TEST(FleetSection, NamesTheBuildingAndItsHub) {
  const Config config = test::good(kFleet + "accept = [\"raw\", \"minutes\"]\nraw_kbit_s = 500\n");
  ASSERT_TRUE(config.fleet);
  EXPECT_EQ(config.fleet->building, "kobe-03");
  EXPECT_EQ(config.fleet->hubs.size(), 2U);
  EXPECT_EQ(config.fleet->accept, (std::vector<std::string>{"raw", "minutes"}));
  EXPECT_EQ(config.fleet->raw_kbit_s, 500);
  EXPECT_FALSE(config.fleet->send_config);
  EXPECT_FALSE(test::good(test::kGoodConfig).fleet);
}

TEST(FleetSection, ReportsProblemsWithTheirLines) {
  for (const auto& [what, by, rule] :
       {std::tuple("\"kobe-03\"", "\"Kobe\"", "must be 1 to 32 of a-z, 0-9 and -"),
        std::tuple("\"kobe-03\"", "\"all\"", "not all"),
        std::tuple("\"kobe-03\"", "\"a.b\"", "must be 1 to 32"),
        std::tuple("\"tls://10.0.0.2:4222\"", "\"nats://10.0.0.2:4222\"", "is not tls://HOST:PORT"),
        std::tuple("\"tls://10.0.0.2:4222\"", "\"tls://10.0.0.2\"", "is not tls://HOST:PORT"),
        std::tuple("\"tls://10.0.0.2:4222\"", "\"tls://10.0.0.2:70000\"", "is not tls://HOST:PORT"),
        std::tuple("\"tls://10.0.0.2:4222\"", "\"tls://me:secret@hub:4222\"",
                   "is not tls://HOST:PORT"),
        std::tuple("\"c.key\"", "\"\"", "must not be empty"),
        std::tuple("ca = ", "accept = [\"reboot\"]\nca = ",
                   "must be acknowledge, raw, resend or minutes, got 'reboot'"),
        std::tuple("ca = \"ca.pem\"", "", "ca")}) {
    const std::string told = problems_of(test::replaced(kFleet, what, by));
    EXPECT_NE(told.find(rule), std::string::npos) << what << " " << by << ": " << told;
    EXPECT_NE(told.find("c.toml:"), std::string::npos) << told;
  }
}

TEST(FleetSection, NeedsAHistory) {
  const std::string told =
      problems_of(test::replaced(kFleet, "[history]\ndirectory = \"h\"\n", ""));
  EXPECT_NE(told.find("needs [history]"), std::string::npos) << told;
}

}  // namespace fleet_test
}  // namespace framewatch::daemon
