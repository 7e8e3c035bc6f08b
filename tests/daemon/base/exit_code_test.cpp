// SPDX-License-Identifier: MIT
#include "daemon/base/exit_code.h"

#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <new>
#include <regex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/base/workers.h"
#include "tests/support/child.h"
#include "tests/support/history_fixture.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace exit_code_test {

namespace fs = std::filesystem;

// Limits.
constexpr std::chrono::seconds kSoon{30};  // for actions that take a fraction of one

const std::string kScenario = FRAMEWATCH_SOURCE_DIR "/configs/scenario_table_two_story.toml";

struct Ran {
  int code;
  std::string said;  ///< on stderr
};

/// Runs `command` of the program in a shell. `command` may redirect stdout.
Ran run(const std::string& command) {
  const test::TemporaryDirectory directory;
  const std::string said = directory.path("said");
  const int status =
      std::system((std::string(FRAMEWATCH_PROGRAM) + " " + command + " 2> " + said).c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), test::read_file(said)};
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(LastResort, ReportsAnExceptionWithStatusTwo) {
  testing::internal::CaptureStderr();
  now_runs("convert", false);
  EXPECT_EQ(run_to_the_end([]() -> int { throw std::runtime_error("nobody expected it"); }), 2);
  EXPECT_EQ(run_to_the_end([]() -> int { throw std::bad_alloc(); }), 2);
  EXPECT_EQ(run_to_the_end([]() -> int { throw 7; }), 2);
  EXPECT_EQ(run_to_the_end([] { return 1; }), 1);
  const std::string said = testing::internal::GetCapturedStderr();
  for (const char* part : {"framewatch convert: nobody expected it", "not enough memory",
                           "an exception of an unknown kind"})
    EXPECT_TRUE(has(said, part)) << said;
}

TEST(LastResort, ReturnsOneForAServiceSoThatItRestarts) {
  testing::internal::CaptureStderr();
  now_runs("run", true);
  EXPECT_EQ(run_to_the_end([]() -> int { throw std::runtime_error("once"); }), 1);
  testing::internal::GetCapturedStderr();
}

TEST(LastResortDeathTest, ReportsAnExceptionThatLeavesAThread) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(
      {
        prepare_last_resort();
        now_runs("replay", false);
        std::thread([] { throw std::runtime_error("in a thread"); }).join();
      },
      testing::ExitedWithCode(2), "framewatch replay: in a thread");
}

TEST(LastResort, WorkersRethrowAnException) {
  const Workers workers(4);
  EXPECT_THROW(workers.run("", 100,
                           [](int i) {
                             if (i == 50) throw std::runtime_error("one of them");
                           }),
               std::runtime_error);
}

TEST(Workers, DoNestedTasksOnce) {
  constexpr int kPieces = 20, kParts = 7;
  const Workers workers(3);
  std::vector<std::vector<int>> done(kPieces, std::vector<int>(kParts, 0));
  workers.run("", kPieces, [&](int i) {
    workers.run_within(kParts, [&](int k) {
      workers.run_within(2, [&](int half) {
        if (half == 1) ++done[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)];
      });
    });
  });
  EXPECT_EQ(done, std::vector<std::vector<int>>(kPieces, std::vector<int>(kParts, 1)));
}

TEST(Workers, RethrowExceptionsOfNestedTasks) {
  const Workers workers(2);
  EXPECT_THROW(workers.run("", 4,
                           [&](int i) {
                             workers.run_within(4, [&](int k) {
                               if (i == 2 && k == 3) throw std::runtime_error("one of them");
                             });
                           }),
               std::runtime_error);
}

TEST(Program, FailsIfStandardOutputIsFull) {
  for (const std::string& command :
       {"check " + test::table_config(), "check --json " + test::table_config(),
        std::string("--help"), std::string("check --print-options-markdown")}) {
    const Ran full = run(command + " > /dev/full");
    EXPECT_EQ(full.code, 2) << command;
    EXPECT_TRUE(has(full.said, "No space left on device")) << command << ": " << full.said;
    EXPECT_EQ(run(command + " > /dev/null").code, 0) << command;
  }
}

TEST(Program, OpensNoFileInPlaceOfAClosedStream) {
  const test::TemporaryDirectory directory;
  const std::string estimates = directory.path("e.csv"), record = directory.path("r.csv");
  test::record_table_test(record, 6);
  const std::string replay = "replay " + test::table_config() + " " + record + " --out ";
  ASSERT_EQ(run(replay + directory.path("whole.csv") + " > /dev/null").code, 0);
  const Ran closed = run(replay + estimates + " >&-");
  EXPECT_EQ(closed.code, 2);
  EXPECT_TRUE(has(closed.said, "standard output")) << closed.said;
  EXPECT_EQ(test::read_file(estimates), test::read_file(directory.path("whole.csv")));
}

TEST(Program, ReportsMissingMemory) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer takes terabytes of addresses";
#endif
  const test::TemporaryDirectory directory;
  const std::string command = "ulimit -v 250000; " FRAMEWATCH_PROGRAM " simulate " +
                              directory.path("s.toml") + " --out " + directory.path("o.csv") +
                              " --seconds 1 2> " + directory.path("said");
  std::string scenario = test::read_file(kScenario);
  const std::string there = "length_s = 3600.0";
  scenario.replace(scenario.find(there), there.size(), "length_s = 100000");
  scenario.replace(scenario.find("table_two"), 5, fs::path(kScenario).parent_path() / "table");
  test::write_file(directory.path("s.toml"), scenario);
  const int status = std::system(command.c_str());
  ASSERT_TRUE(WIFEXITED(status)) << "ended by a signal";
  EXPECT_EQ(WEXITSTATUS(status), 2);
  const std::string said = test::read_file(directory.path("said"));
  EXPECT_TRUE(has(said, "framewatch simulate: there is not enough memory")) << said;
  EXPECT_FALSE(fs::exists(directory.path("o.csv")));
  EXPECT_FALSE(fs::exists(directory.path("o.csv.partial")));
}

TEST(Program, LeavesNoIncompleteFileAfterASignal) {
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE})
    for (const std::string name : {"o.csv", "o.csv.gz", "o.lcmlog"}) {
      const test::TemporaryDirectory directory;
      const std::string out = directory.path(name);
      test::write_file(out, "what was there");
      test::Child child({FRAMEWATCH_PROGRAM, "simulate", kScenario, "--out", out, "--seconds",
                         "500000", "--quiet", "--truth", directory.path("t.json")});
      ASSERT_TRUE(test::comes_true([&] { return fs::exists(out + ".partial"); }, kSoon));
      EXPECT_EQ(child.stop(number), 128 + number) << name;
      EXPECT_EQ(directory.names(), std::vector<std::string>{name}) << number;
      EXPECT_EQ(test::read_file(out), "what was there");
    }
}

TEST(Program, ReportsLinksInACircle) {
  const test::TemporaryDirectory directory;
  fs::create_symlink(directory.path("b"), directory.path("a"));
  fs::create_symlink(directory.path("a"), directory.path("b"));
  const std::string config = directory.path("c.toml"),
                    table = test::read_file(test::table_config());
  for (const std::string section : {"[watch]\nbaseline = \"a\"\n", "[gap]\nmodel = \"a\"\n"}) {
    test::write_file(config, table + section);
    const Ran ran = run("check " + config);
    EXPECT_EQ(ran.code, 2) << ran.said;
    EXPECT_TRUE(has(ran.said, "Too many levels of symbolic links")) << ran.said;
    EXPECT_FALSE(has(ran.said, "nothing expected")) << ran.said;
  }
  for (const std::string& command : std::vector<std::string>{
           "check A", "replay A A", "replay " + test::table_config() + " A", "repair A",
           "convert A B.csv", "simulate A --out B.csv", "history A", "report A", "diff A A",
           "replay --load-state A " + test::table_config() + " A"}) {
    const std::string named =
        std::regex_replace(command, std::regex("\\bA\\b"), directory.path("a"));
    const Ran ran = run(named + " > /dev/null");
    EXPECT_EQ(ran.code, 2) << named << ran.said;
    EXPECT_FALSE(has(ran.said, "nothing expected")) << named << ran.said;
  }
}

TEST(Program, ReportsADirectoryAsAState) {
  const test::TemporaryDirectory directory;
  const std::string record = directory.path("r.csv"), state = directory.path("state");
  test::record_table_test(record, 6);
  fs::create_directory(state);
  const std::string replay =
      "replay " + test::table_config() + " " + record + " --out " + directory.path("e.csv");
  for (const std::string option : {" --load-state ", " --save-state "}) {
    const Ran ran = run(replay + option + state + " > /dev/null");
    EXPECT_EQ(ran.code, 2) << ran.said;
    EXPECT_TRUE(has(ran.said, "state: is a directory")) << ran.said;
    EXPECT_FALSE(has(ran.said, "nothing expected")) << ran.said;
  }
}

}  // namespace exit_code_test
}  // namespace framewatch::daemon
