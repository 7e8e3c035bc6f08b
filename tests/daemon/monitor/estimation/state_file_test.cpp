// SPDX-License-Identifier: MIT
#include "daemon/monitor/estimation/state_file.h"

#include <malloc.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "daemon/monitor/live/run_command.h"
#include "daemon/tools/replay/replay_command.h"
#include "drivers/lcm/lcm_log.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace state_file_test {

using drivers::LcmLogReader;
using drivers::LogEvent;
using drivers::LogRead;
using test::read_file;
using test::TemporaryDirectory;
using test::write_file;

constexpr double kSeconds = 11;
constexpr int kNodes = 10, kFilledWith = 165;

Config table() {
  std::vector<ConfigProblem> problems;
  return *load_config(test::table_config(), problems);
}

class StateFile : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    ::mallopt(M_PERTURB, kFilledWith);  // a state must not depend on old memory contents
    directory_ = new TemporaryDirectory;
    test::record_table_test(log(), kSeconds);
    ASSERT_EQ(run({log()}, "uncut.lcmlog", "", ""), 0);
  }
  static void TearDownTestSuite() {
    ::mallopt(M_PERTURB, 0);
    delete directory_;
  }

  static std::string path(const std::string& name) { return directory_->path(name); }
  static std::string log() { return path("rec.lcmlog"); }

  static ReplayArguments arguments(std::vector<std::string> logs, const std::string& out,
                                   const std::string& load, const std::string& save) {
    ReplayArguments a{
        test::table_config(), std::move(logs), out.empty() ? "" : path(out), false, true, false};
    a.one_pass = true;  // because parts are estimated
    if (!load.empty()) a.load_state = path(load);
    if (!save.empty()) a.save_state = path(save);
    return a;
  }
  static int run(std::vector<std::string> logs, const std::string& out, const std::string& load,
                 const std::string& save) {
    return replay(arguments(std::move(logs), out, load, save));
  }
  /// Returns the exit code and the output of a replay that resumes from "state".
  static std::pair<int, std::string> refused() {
    testing::internal::CaptureStderr();
    const int code = run({log()}, "est.lcmlog", "state", "");
    EXPECT_FALSE(std::filesystem::exists(path("est.lcmlog")));
    return {code, testing::internal::GetCapturedStderr()};
  }

  inline static TemporaryDirectory* directory_ = nullptr;
};

TEST_F(StateFile, AReplayInTwoPartsGivesTheBytesOfOne) {
  const std::string bytes = read_file(log());
  LcmLogReader reader;
  ASSERT_TRUE(reader.open(log()));
  std::vector<std::int64_t> offsets;
  for (LogEvent e; reader.next(e) == LogRead::event;) offsets.push_back(e.offset);
  // Cuts after the first sample, inside an instant, between a table and its samples, while warming
  // up, while re-tuning, while values are published, and before the last message.
  for (const std::size_t cut :
       {std::size_t{2}, std::size_t{5}, std::size_t{1001}, std::size_t{4444}, std::size_t{6010},
        std::size_t{7503}, std::size_t{9999}, offsets.size() - 1}) {
    const auto at = static_cast<std::size_t>(offsets[cut]);
    write_file(path("1"), bytes.substr(0, at));
    write_file(path("2"), bytes.substr(at));
    ASSERT_EQ(run({path("1")}, "a.lcmlog", "", "state"), 0) << cut;
    ASSERT_EQ(run({path("2")}, "b.lcmlog", "state", ""), 0) << cut;
    EXPECT_TRUE(read_file(path("a.lcmlog")) + read_file(path("b.lcmlog")) ==
                read_file(path("uncut.lcmlog")))
        << "cut before event " << cut;
  }
}

TEST_F(StateFile, ContinuesWithinALog) {
  ReplayArguments first = arguments({log()}, "a.lcmlog", "", "state");
  first.span.to_s = 8.5;
  ReplayArguments second = arguments({log()}, "b.lcmlog", "state", "");
  second.span.from_s = 8.5;
  ASSERT_EQ(replay(first), 0);
  ASSERT_EQ(replay(second), 0);
  EXPECT_TRUE(read_file(path("a.lcmlog")) + read_file(path("b.lcmlog")) ==
              read_file(path("uncut.lcmlog")));
}

TEST_F(StateFile, CsvPartsJoinToOneTable) {
  ASSERT_EQ(run({log()}, "uncut.csv", "", ""), 0);
  ReplayArguments first = arguments({log()}, "a.csv", "", "state");
  first.span.to_s = 9;
  ReplayArguments second = arguments({log()}, "b.csv", "state", "");
  second.span.from_s = 9;
  ASSERT_EQ(replay(first), 0);
  ASSERT_EQ(replay(second), 0);
  EXPECT_TRUE(read_file(path("a.csv")) + read_file(path("b.csv")) == read_file(path("uncut.csv")));
}

TEST_F(StateFile, RefusesDamagedTruncatedAndForeignFilesWithTheReason) {
  ASSERT_EQ(run({log()}, "", "", "good"), 0);
  const std::string good = read_file(path("good"));
  ASSERT_GT(good.size(), 10000u);
  for (const auto& [at, problem] :
       std::map<std::size_t, std::string>{{good.size() / 3, "section window is damaged"},
                                          {good.size() - 1, "section window is damaged"},
                                          {100, "the digest of its head does not match"}}) {
    std::string bad = good;
    bad[at] ^= 1;
    write_file(path("state"), bad);
    const auto [code, said] = refused();
    EXPECT_EQ(code, 2);
    EXPECT_NE(said.find(problem), std::string::npos) << said;
  }
  write_file(path("state"), good.substr(0, good.size() / 2));
  EXPECT_NE(refused().second.find("section window is cut off"), std::string::npos);
  write_file(path("state"), "something else");
  EXPECT_NE(refused().second.find("is not a state of framewatch"), std::string::npos);
  std::filesystem::remove(path("state"));
  EXPECT_NE(refused().second.find("No such file or directory"), std::string::npos);

  write_file(path("other.toml"), read_file(test::table_config()) + "\n# changed\n");
  write_file(path("state"), good);
  ReplayArguments a = arguments({log()}, "", "state", "");
  a.config = path("other.toml");
  testing::internal::CaptureStderr();
  EXPECT_EQ(replay(a), 2);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("belongs to another configuration"),
            std::string::npos);
}

/// Plays the events [from, to) of a log through a daemon in this process.
std::int64_t live(const Config& config, const std::string& log, int from, int to,
                  const std::string& state_in, const std::string& state_out) {
  drivers::LcmProvider lcm("memq://");
  LiveEstimation estimation(config, lcm);
  bool touched = false;
  if (!state_in.empty()) {
    EXPECT_EQ(load_state(state_in, config, estimation.estimation(), touched).problem, "");
  }
  LcmLogReader reader;
  EXPECT_TRUE(reader.open(log));
  int n = 0;
  for (LogEvent e; reader.next(e) == LogRead::event && n < to; ++n) {
    if (n < from) continue;
    lcm.publish(e.channel, e.data.data(), static_cast<unsigned>(e.data.size()));
    EXPECT_TRUE(estimation.poll(0));
  }
  if (!state_out.empty()) {
    EXPECT_EQ(write_state(state_out, saved_state(config, estimation.estimation(), 0)), "");
  }
  return estimation.estimation().windows();
}

TEST_F(StateFile, TheDaemonSurvivesARestart) {
  const Config config = table();
  const int half = kNodes * 600, all = 1'000'000;
  const std::int64_t uncut = live(config, log(), 0, all, "", "");
  const std::int64_t before = live(config, log(), 0, half, "", path("state"));
  EXPECT_GT(before, 500);
  EXPECT_EQ(live(config, log(), half, all, path("state"), ""), uncut);
}

/// Runs framewatch run with a state file. Returns 0 if it stops on SIGTERM.
int run_and_stop(const std::string& state, const std::string& err) {
  const pid_t pid = ::fork();
  if (pid == 0) {
    if (std::freopen(err.c_str(), "w", stderr) == nullptr) ::_exit(126);
    ::execl(FRAMEWATCH_PROGRAM, FRAMEWATCH_PROGRAM, "run", test::table_config().c_str(), "--url",
            "memq://", "--state", state.c_str(), "--state-every", "1", nullptr);
    ::_exit(127);
  }
  for (int i = 0; i < 500 && read_file(err).find("channels on") == std::string::npos; ++i)
    ::usleep(20'000);
  ::kill(pid, SIGTERM);
  int status = 0;
  ::waitpid(pid, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

TEST_F(StateFile, RunReadsAndWritesItAndSetsAForeignOneAside) {
  const TemporaryDirectory own;
  EXPECT_EQ(run_and_stop(own.path("state"), own.path("first")), 0);
  ASSERT_TRUE(std::filesystem::exists(own.path("state")));
  EXPECT_EQ(run_and_stop(own.path("state"), own.path("second")), 0);
  EXPECT_NE(read_file(own.path("second")).find("resumed from"), std::string::npos)
      << read_file(own.path("second"));
  write_file(own.path("state"), "not ours");
  EXPECT_EQ(run_and_stop(own.path("state"), own.path("third")), 0);
  EXPECT_NE(read_file(own.path("third")).find("is not a state of framewatch; started without it"),
            std::string::npos)
      << read_file(own.path("third"));
  EXPECT_EQ(read_file(own.path("state.refused")), "not ours");
}

}  // namespace state_file_test
}  // namespace framewatch::daemon
