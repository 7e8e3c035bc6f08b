// SPDX-License-Identifier: MIT
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "daemon/base/exit_code.h"
#include "tests/support/child.h"
#include "tests/support/shell.h"

namespace framewatch::daemon {
namespace streams_test {

using test::ShellResult;

constexpr std::chrono::seconds kPatience{60};

class Streams : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"table_two_story.toml", "scenario_table_two_story.toml"})
      std::filesystem::copy(std::string(FRAMEWATCH_SOURCE_DIR "/configs/") + name,
                            directory_.path(name));
  }
  ShellResult shell(const std::string& line) { return test::shell(directory_, line); }
  void expect(const std::string& line) {
    const ShellResult said = shell(line);
    EXPECT_EQ(said.status, 0) << line << "\n" << said.err;
  }
  std::string read(const std::string& name) { return test::read_file(directory_.path(name)); }

  test::TemporaryDirectory directory_;
  const std::string simulate_ = "$F simulate scenario_table_two_story.toml --quiet --seconds 12 ";
};

TEST_F(Streams, AChainOfPipesGivesTheSameAsFiles) {
  expect(simulate_ + "--out record.csv");
  expect("$F replay table_two_story.toml record.csv --out by-file.csv --quiet");
  expect("set -o pipefail; " + simulate_ +
         "--out - | $F replay table_two_story.toml - --out - --quiet >by-pipe.csv");
  ASSERT_GT(read("by-file.csv").size(), 10000u);
  EXPECT_EQ(read("by-pipe.csv"), read("by-file.csv"));
}

TEST_F(Streams, EventLogsPassThroughPipes) {
  expect(simulate_ + "--out record.lcmlog");
  expect("$F convert record.lcmlog by-file.csv");
  expect("cat record.lcmlog | $F convert - - >by-pipe.csv");
  ASSERT_GT(read("by-file.csv").size(), 10000u);
  EXPECT_EQ(read("by-pipe.csv"), read("by-file.csv"));
}

TEST_F(Streams, TheSummaryDoesNotMixWithDataOnStandardOutput) {
  expect(simulate_ + "--out record.csv");
  const ShellResult said = shell("$F replay table_two_story.toml record.csv --out -");
  EXPECT_EQ(said.status, 0);
  EXPECT_TRUE(said.out.starts_with("window_end_s,status,")) << said.out.substr(0, 80);
  EXPECT_NE(said.err.find("s of motion in"), std::string::npos);
  EXPECT_EQ(shell("$F replay table_two_story.toml record.csv --out - --json").status, kBadInput);
  EXPECT_EQ(
      shell("$F replay table_two_story.toml record.csv --out - --write-baseline - --quiet").status,
      kBadInput);
}

TEST_F(Streams, PipedConfigurationsResolvePathsInTheWorkingDirectory) {
  EXPECT_TRUE(shell("cat table_two_story.toml | $F check -").out.starts_with("/dev/stdin: good"));
  // Its key config names a file in the working directory.
  expect("cat scenario_table_two_story.toml | $F simulate - --quiet --seconds 1 --out x.csv");
  EXPECT_NE(shell("echo nonsense | $F check -").err.find("/dev/stdin:1:"), std::string::npos);
}

TEST_F(Streams, AReportToAFullDiskFails) {
  expect(simulate_ + "--out record.csv");
  expect("$F replay table_two_story.toml record.csv --out est.lcmlog --quiet");
  EXPECT_TRUE(shell("$F report est.lcmlog --out -").out.starts_with("<!doctype html>"));
  const ShellResult full = shell("$F convert est.lcmlog - >/dev/full");
  EXPECT_EQ(full.status, kBadInput);
  EXPECT_NE(full.err.find("No space left on device"), std::string::npos) << full.err;
}

TEST_F(Streams, StandardInputServesOneFile) {
  EXPECT_EQ(shell("$F replay - -").err,
            "framewatch replay: - is standard input and can be given only once\n");
  EXPECT_NE(shell("head -c 3000 /dev/zero | $F check - --max-size 1").err, "");
  const ShellResult empty = shell("$F replay table_two_story.toml - --out x.csv");
  EXPECT_EQ(empty.status, kBadInput);
  EXPECT_NE(empty.err.find("/dev/stdin: is empty"), std::string::npos) << empty.err;
  EXPECT_NE(shell("$F replay table_two_story.toml - --out x.csv --max-size 1000 < "
                  "<(head -c 3000 /dev/zero)")
                .err.find("is longer than 1000 bytes"),
            std::string::npos);
}

TEST_F(Streams, InterruptedWorkLeavesNoFileAndSaysSo) {
  test::Child work(
      {"/bin/sh", "-c",
       "cd " + directory_.path("") +
           " && exec " FRAMEWATCH_PROGRAM
           " simulate scenario_table_two_story.toml --seconds 1000000 --out x.csv 2>said"});
  const auto until = std::chrono::steady_clock::now() + kPatience;
  while (!std::filesystem::exists(directory_.path("x.csv.partial")) &&
         std::chrono::steady_clock::now() < until)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(work.stop(SIGINT), 128 + SIGINT);
  EXPECT_FALSE(std::filesystem::exists(directory_.path("x.csv.partial")));
  EXPECT_FALSE(std::filesystem::exists(directory_.path("x.csv")));
  EXPECT_NE(read("said").find("removed x.csv.partial\n"), std::string::npos) << read("said");
}

TEST_F(Streams, AnInterruptedRunKeepsItsFrames) {
  if (const char* reason = std::getenv("FRAMEWATCH_NO_MULTICAST")) GTEST_SKIP() << reason;
  test::write_file(directory_.path("frames.partial"), "(1.0) can0 123#00\n");
  test::Child run({"/bin/sh", "-c",
                   "cd " + directory_.path("") +
                       " && exec " FRAMEWATCH_PROGRAM
                       " run table_two_story.toml --can-log frames 2>said"});
  const auto until = std::chrono::steady_clock::now() + kPatience;
  while (read("said").find("10 channels on") == std::string::npos &&
         std::chrono::steady_clock::now() < until)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(run.stop(SIGINT), 0);
  EXPECT_NE(read("said").find("kept them in frames.cut-off-1"), std::string::npos) << read("said");
  EXPECT_EQ(read("frames.cut-off-1"), "(1.0) can0 123#00\n");
  EXPECT_EQ(read("frames"), "");
}

/// Runs on a terminal of script(1).
TEST_F(Streams, ProgressAndColorAppearOnlyOnTerminals) {
  const std::string slow = "$F simulate scenario_table_two_story.toml --seconds 6000 --out x.csv";
  const auto on_terminal = [&](const std::string& before, const std::string& line) {
    return shell("type -p script >/dev/null || exit 9; export TERM=xterm " + before +
                 "; script -qec \"" + line + "\" /dev/null");
  };
  const ShellResult shown = on_terminal("", slow);
  if (shown.status == 9) GTEST_SKIP() << "no script(1)";
  EXPECT_NE(shown.out.find(" left, "), std::string::npos) << shown.out;
  EXPECT_EQ(shell(slow).err.find(" left, "), std::string::npos);

  const std::string wrong = "$F check none.toml";
  EXPECT_NE(on_terminal("", wrong).out.find("\x1b[31mnone.toml:\x1b[0m"), std::string::npos);
  EXPECT_EQ(on_terminal("NO_COLOR=1", wrong).out.find('\x1b'), std::string::npos);
  EXPECT_NE(on_terminal("NO_COLOR=", wrong).out.find('\x1b'), std::string::npos);
  EXPECT_EQ(on_terminal("TERM=dumb", wrong).out.find('\x1b'), std::string::npos);
  EXPECT_EQ(shell("export TERM=xterm; " + wrong).err.find('\x1b'), std::string::npos);
}

}  // namespace streams_test
}  // namespace framewatch::daemon
