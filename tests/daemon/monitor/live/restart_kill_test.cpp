// SPDX-License-Identifier: MIT
// Kills the program in the middle of an earthquake, as a power cut does (SIGKILL).
#include <csignal>
#include <cstdlib>
#include <thread>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "daemon/monitor/event_report/event_report_files.h"
#include "daemon/monitor/history/history_files.h"
#include "tests/support/child.h"
#include "tests/support/history_fixture.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace restart_kill_test {

using namespace std::chrono_literals;

// Limits.
constexpr auto kSoon = 60s;       // for actions that take some seconds on an idle machine
constexpr double kMaxLost_s = 1;  // raw samples lost at a kill: half a second and the way to here

constexpr auto kShakenBefore = 3s;
constexpr auto kAway = 1s;  // a shorter absence is not reported
constexpr int kSpeed = 2;

TEST(RestartKill, TheReportCoversTheWholeEarthquakeAndNamesMissingTimes) {
  if (const char* reason = std::getenv("FRAMEWATCH_NO_MULTICAST")) GTEST_SKIP() << reason;
  const test::TemporaryDirectory directory;
  const std::string configs = std::string(FRAMEWATCH_SOURCE_DIR) + "/configs/";
  std::string scenario = test::read_file(configs + "scenario_table_two_story.toml");
  const auto set = [&](const std::string& what, const std::string& by) {
    const std::size_t at = scenario.find(what);
    ASSERT_NE(at, std::string::npos) << what;
    scenario.replace(at, what.size(), by);
  };
  set("\"table_two_story.toml\"", "\"" + configs + "table_two_story.toml\"");
  set("length_s = 3600.0", "length_s = 24");
  set("strong_s = 100000.0", "strong_s = 16");
  test::write_file(directory.path("scenario.toml"), scenario);
  test::write_file(directory.path("table.toml"),
                   test::read_file(test::table_config()) +
                       "\n[history]\ndirectory = \"h\"\n[event_report]\ndirectory = \"reports\"\n"
                       "quiet_s = 3\n");
  const auto run = [&] {
    return std::vector<std::string>{FRAMEWATCH_PROGRAM, "run",     directory.path("table.toml"),
                                    "--quiet",          "--state", directory.path("state"),
                                    "--state-every",    "1"};
  };
  test::Child first(run());
  const auto stored = [&] { return !raw_logs(raw_folder(directory.path("h"))).empty(); };
  test::Child building({FRAMEWATCH_PROGRAM, "simulate", directory.path("scenario.toml"), "--lcm",
                        "--seconds", "600", "--speed", std::to_string(kSpeed), "--quiet"});
  ASSERT_TRUE(test::comes_true(stored, kSoon)) << "no samples are recorded";
  std::this_thread::sleep_for(kShakenBefore);
  first.stop(SIGKILL);
  const auto counts = test::raw_counts(directory.path("h"));
  ASSERT_FALSE(counts.empty());
  const std::int64_t heard_us = counts.back().time_us;

  std::this_thread::sleep_for(kAway);
  test::Child second(run());
  const std::string reports = directory.path("reports");
  ASSERT_TRUE(test::comes_true([&] { return !event_report_names(reports).empty(); }, kSoon));
  EXPECT_EQ(second.stop(SIGTERM), 0);
  const std::vector<std::string> names = event_report_names(reports);
  ASSERT_EQ(names.size(), 1u);
  const auto report = nlohmann::json::parse(test::read_file(reports + "/" + names[0] + ".json"));
  EXPECT_LT(report["start_us"].get<std::int64_t>(), heard_us);
  ASSERT_GE(report["unheard"].size(), 1u);
  // The first process may have started late; the newest entry is the kill.
  const auto& unheard = report["unheard"].back();
  EXPECT_EQ(unheard["why"], "restart") << unheard;
  EXPECT_EQ(unheard["message"].get<std::string>().find("Nobody listened from "), 0u) << unheard;
  // All stored samples are known, not only those of the state.
  EXPECT_NEAR(1e-6 * static_cast<double>(unheard["from_us"].get<std::int64_t>() - heard_us), 0,
              kMaxLost_s * kSpeed);
  EXPECT_NE(report["verdict"], "green");
}

}  // namespace restart_kill_test
}  // namespace framewatch::daemon
