// SPDX-License-Identifier: MIT
#include "daemon/tools/session/record_command.h"

#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <thread>

#include <framewatch/session_command_t.hpp>

#include <gtest/gtest.h>
#include <lcm/lcm-cpp.hpp>

#include "daemon/base/process.h"
#include "daemon/tools/report/session_file.h"
#include "daemon/tools/session/session_finish.h"
#include "drivers/lcm/lcm_log.h"
#include "drivers/lcm/lcm_source.h"
#include "tests/daemon/tools/session/recorder_bench.h"
#include "tests/support/child.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace record_test {

// Limits.
constexpr std::int64_t kInstant_us = 10'000;  // between two samples of a node
constexpr double kLostByCrash_s = 1.5;        // largest loss before a kill

namespace fs = std::filesystem;
using drivers::LcmLogReader;
using drivers::LogEvent;
using drivers::LogRead;

/// Runs three processes over LCM; `during` runs in the middle of the recording.
struct LiveSession {
  test::TemporaryDirectory directory;
  std::string folder;
  int exit_code = -1;

  LiveSession(const std::vector<std::string>& options,
              const std::function<void(test::Child& estimator, test::Child& recorder)>& during) {
    test::Child estimator({FRAMEWATCH_PROGRAM, "run", test::table_config(), "--quiet"});
    std::vector<std::string> command{FRAMEWATCH_PROGRAM,         "record",
                                     test::table_config(),       "--out",
                                     directory.path("sessions"), "--quiet"};
    command.insert(command.end(), options.begin(), options.end());
    test::Child recorder(command);
    test::Child building({FRAMEWATCH_PROGRAM, "simulate",
                          FRAMEWATCH_SOURCE_DIR "/configs/scenario_table_two_story.toml", "--lcm",
                          "--seconds", "24", "--speed", "2", "--quiet"});
    std::this_thread::sleep_for(std::chrono::seconds(3));
    during(estimator, recorder);
    exit_code = recorder.wait();
    for (const auto& entry : fs::directory_iterator(directory.path("sessions")))
      if (entry.is_directory()) folder = entry.path().string();
    building.stop(SIGINT);
    estimator.stop(SIGKILL);
  }
};

bool no_multicast(std::string& error) {
  if (const char* reason = std::getenv("FRAMEWATCH_NO_MULTICAST")) error = reason;
  return !error.empty() || !drivers::open_lcm(test::table_configuration().lcm.url, {}, error);
}

/// Counts missing samples of one node between its first and last.
std::int64_t missing_in(const std::vector<std::int64_t>& times) {
  const std::map<std::int64_t, int> nodes = [&] {
    std::map<std::int64_t, int> count;
    for (const std::int64_t t : times) ++count[t];
    return count;
  }();
  std::int64_t missing = 0;
  for (auto at = std::next(nodes.begin()); at != nodes.end(); ++at)
    missing += (at->first - std::prev(at)->first) / kInstant_us - 1;
  return missing;
}

TEST(Record, AnEstimatorCrashCostsNoSample) {
  std::string why;
  if (no_multicast(why)) GTEST_SKIP() << why;
  const LiveSession live({"--no-check", "--seconds", "14"},
                         [](test::Child& estimator, test::Child&) { estimator.stop(SIGKILL); });
  EXPECT_EQ(live.exit_code, 0);
  const auto times = test::times_of(live.folder + "/raw.lcmlog");
  EXPECT_GT(times.size(), 13000u);
  EXPECT_EQ(missing_in(times), 0);
  // There is a report nevertheless.
  EXPECT_TRUE(fs::exists(live.folder + "/estimates-replayed.lcmlog"));
  EXPECT_TRUE(fs::exists(live.folder + "/report.html"));
}

TEST(Record, AKilledRecorderLosesAtMostASecond) {
  std::string why;
  if (no_multicast(why)) GTEST_SKIP() << why;
  std::int64_t killed_us = 0;
  const LiveSession live({"--no-check", "--seconds", "100"},
                         [&](test::Child&, test::Child& recorder) {
                           killed_us = std::chrono::duration_cast<std::chrono::microseconds>(
                                           std::chrono::system_clock::now().time_since_epoch())
                                           .count();
                           recorder.signal(SIGKILL);
                         });
  EXPECT_EQ(live.exit_code, 128 + SIGKILL);
  EXPECT_FALSE(fs::exists(live.folder + "/raw.lcmlog"));
  EXPECT_EQ(
      finish_session({test::table_config(), live.folder, "", false, false, false, true, true}), 0);
  LcmLogReader reader;
  ASSERT_TRUE(reader.open(live.folder + "/raw.lcmlog"));
  LogEvent event;
  std::int64_t last_us = 0;
  while (reader.next(event) == LogRead::event) last_us = event.timestamp_us;
  EXPECT_GT(static_cast<double>(last_us), static_cast<double>(killed_us) - 1e6 * kLostByCrash_s);
  EXPECT_EQ(missing_in(test::times_of(live.folder + "/raw.lcmlog")), 0);
  EXPECT_TRUE(fs::exists(live.folder + "/report.html"));
}

TEST(Record, AnswersToCommandsFromAnotherTerminal) {
  std::string why;
  if (no_multicast(why)) GTEST_SKIP() << why;
  const test::TemporaryDirectory runtime;
  ::setenv("XDG_RUNTIME_DIR", runtime.path("").c_str(), 1);
  const auto send = [](const char* verb) {
    return test::Child({FRAMEWATCH_PROGRAM, "record", test::table_config(), "--send", verb}).wait();
  };
  EXPECT_EQ(send("start"), 1);  // no daemon
  const LiveSession live({"--standby", "--no-report"}, [&](test::Child&, test::Child& recorder) {
    EXPECT_EQ(send("stop"), 1);
    session_command_t forged{};
    forged.id = 77;
    forged.verb = "start";
    lcm::LCM(test::table_configuration().lcm.url)
        .publish("FRAMEWATCH_SESSION_COMMAND", &forged);  // lcm.commands = false
    std::this_thread::sleep_for(std::chrono::seconds(1));
    EXPECT_EQ(send("start"), 0);
    std::this_thread::sleep_for(std::chrono::seconds(1));
    EXPECT_EQ(send("start"), 1);
    EXPECT_EQ(send("stop"), 0);
    std::this_thread::sleep_for(std::chrono::seconds(2));
    recorder.signal(SIGTERM);
  });
  EXPECT_EQ(live.exit_code, 0);
  EXPECT_GT(test::times_of(live.folder + "/raw.lcmlog").size(), 1000u);
  const auto session = read_session_file(live.folder + "/" + kSessionJson, why);
  ASSERT_TRUE(session) << why;
  EXPECT_EQ(session->asked_by, user_name(::geteuid()));
  ::unsetenv("XDG_RUNTIME_DIR");
}

TEST(Record, RefusesImpossibleRequests) {
  RecordArguments a;
  a.config = "/nonexistent.toml";
  EXPECT_EQ(record(a), 2);
  a.config = test::table_config();
  a.request.length_s = -1;
  EXPECT_EQ(record(a), 2);
  a.request.length_s = 0;
  a.url = "bogus://";
  EXPECT_EQ(record(a), 2);
  a.send = "start";  // a session command that is not sent over LCM
  EXPECT_EQ(record(a), 2);
  a.send.clear();
  a.finish = "/nonexistent";
  EXPECT_EQ(record(a), 2);
}

}  // namespace record_test
}  // namespace framewatch::daemon
