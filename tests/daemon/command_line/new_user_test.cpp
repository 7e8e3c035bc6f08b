// SPDX-License-Identifier: MIT
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "daemon/base/exit_code.h"
#include "tests/support/shell.h"

namespace framewatch::daemon {
namespace new_user_test {

using test::ShellResult;

/// Runs the commands of a user who follows README.md for the first time.
class NewUser : public testing::Test {
 protected:
  void SetUp() override {
    test::write_file(directory_.path("building.toml"), example("```toml"));
    test::write_file(directory_.path("record.csv"), example("```\ntime_s"));
  }

  /// Returns the first block of README.md with this beginning, without its fences.
  static std::string example(const std::string& begin) {
    const std::string readme = test::read_file(FRAMEWATCH_SOURCE_DIR "/README.md");
    const std::size_t at = readme.find(begin), from = readme.find('\n', at) + 1;
    return readme.substr(from, readme.find("```", from) - from);
  }
  ShellResult shell(const std::string& line) { return test::shell(directory_, line); }
  void copy(const std::string& name) {
    std::filesystem::copy(FRAMEWATCH_SOURCE_DIR "/configs/" + name, directory_.path(name));
  }

  test::TemporaryDirectory directory_;
};

TEST_F(NewUser, ARecordOfTwoRowsGivesNoWindowWithTheReason) {
  ASSERT_EQ(shell("$F convert record.csv record.lcmlog").status, 0);
  const ShellResult said = shell("$F replay building.toml record.lcmlog --out est.lcmlog");
  EXPECT_EQ(said.status, 0);
  EXPECT_NE(said.err.find("no window: there are 0.01 s of motion, too few samples to fill the "
                          "estimator's filters. Give a record of at least 5 s"),
            std::string::npos)
      << said.err;
}

TEST_F(NewUser, RunRefusesABuildingWithoutSources) {
  ASSERT_EQ(shell("sed -i '/^source/d' building.toml").status, 0);
  for (const char* command : {"run", "record"}) {
    const ShellResult said = shell(std::string("timeout 60 $F ") + command + " building.toml");
    EXPECT_EQ(said.status, kBadInput) << command;
    EXPECT_NE(said.err.find("building.toml: no channel has a source"), std::string::npos)
        << said.err;
  }
  const std::string said = shell("timeout -s TERM 2 $F run building.toml --by-name --quiet").err;
  EXPECT_EQ(said.find("has a source"), std::string::npos) << said;
  EXPECT_NE(said.find("no message carries base yet"), std::string::npos) << said;
}

TEST_F(NewUser, RecordingWithoutSensorsEndsWithAMessage) {
  const ShellResult said = shell("timeout 60 $F record building.toml --by-name --wait 1");
  EXPECT_EQ(said.status, kFailed);
  EXPECT_NE(said.err.find("no samples for 1 s (--wait): nothing was recorded"), std::string::npos)
      << said.err;
}

TEST_F(NewUser, ConvertWritesTheMainWindowAndSaysSo) {
  copy("table_two_story.toml");
  copy("scenario_table_two_story.toml");
  ASSERT_EQ(shell("$F simulate scenario_table_two_story.toml --seconds 20 --quiet --out r.csv &&"
                  "$F replay table_two_story.toml r.csv --quiet --out est.lcmlog &&"
                  "$F replay table_two_story.toml r.csv --quiet --out direct.csv")
                .status,
            0);
  const ShellResult said = shell("$F convert est.lcmlog main.csv");
  EXPECT_EQ(said.status, 0) << said.err;
  EXPECT_NE(said.err.find("the main window's estimates, of FRAMEWATCH_ESTIMATE; --channel takes "
                          "those of another length: FRAMEWATCH_ESTIMATE_10S"),
            std::string::npos)
      << said.err;
  EXPECT_EQ(test::read_file(directory_.path("main.csv")),
            test::read_file(directory_.path("direct.csv")));
  EXPECT_EQ(shell("$F convert est.lcmlog short.csv --channel FRAMEWATCH_ESTIMATE_1S").err, "");
  EXPECT_NE(test::read_file(directory_.path("short.csv")),
            test::read_file(directory_.path("main.csv")));
  EXPECT_EQ(shell("$F convert est.lcmlog x.csv --channel ESTIMATE").status, kBadInput);
}

TEST_F(NewUser, CheckRecognizesAScenario) {
  copy("table_two_story.toml");
  copy("scenario_table_two_story.toml");
  const ShellResult good = shell("$F check scenario_table_two_story.toml");
  EXPECT_EQ(good.status, 0) << good.err;
  EXPECT_TRUE(good.out.starts_with(
      "scenario_table_two_story.toml: a scenario for framewatch simulate, good"));
  const ShellResult bad = shell(
      "sed 's/^seed = .*/seed = -1/' scenario_table_two_story.toml >bad.toml; $F check bad.toml");
  EXPECT_EQ(bad.status, kBadInput);
  EXPECT_NE(bad.err.find("bad.toml: a scenario, 1 problem\n"), std::string::npos) << bad.err;
  const ShellResult run = shell("$F run scenario_table_two_story.toml");
  EXPECT_EQ(run.status, kBadInput);
  EXPECT_NE(run.err.find("this is a scenario, for framewatch simulate and check"),
            std::string::npos);
  EXPECT_EQ(run.err.find('\n'), run.err.size() - 1) << run.err;
}

}  // namespace new_user_test
}  // namespace framewatch::daemon
