// SPDX-License-Identifier: MIT
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include <framewatch/history_status_t.hpp>

#include "daemon/base/clocks.h"
#include "daemon/base/sqlite_file.h"
#include "daemon/monitor/history/history_files.h"
#include "drivers/lcm/accel_codec.h"
#include "drivers/lcm/lcm_source.h"
#include "drivers/lcm/message_check.h"
#include "tests/support/child.h"
#include "tests/support/history_fixture.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace history_kill_test {

// Limits.
constexpr double kMaxLost_s = 1;  // of raw samples, at a kill
/// From the start to the first recorded sample: in the full run, alone on the machine, and among
/// other tests.
constexpr double kLongestRestart_s = 3, kLongestAmongOthers_s = 30;
constexpr std::int64_t kOnTheWay_us = 60'000;  // the way of the last sample to the other process

constexpr int kKills = 12;  // FRAMEWATCH_KILLS=200 makes the full run
constexpr unsigned kSeed = 20261121;

int kills() {
  const char* count = std::getenv("FRAMEWATCH_KILLS");
  return count == nullptr ? kKills : std::atoi(count);
}

/// The input from LCM while the daemon is killed and restarted: time of the newest sample, and
/// status of the history.
struct Bus {
  std::int64_t newest_us = 0;
  std::int64_t status_us = 0, committed_us = 0;
  std::string directory;
  void on_sample(const lcm::ReceiveBuffer* buffer, const std::string&) {
    if (const auto us = drivers::accel_time_us(buffer->data, buffer->data_size)) newest_us = *us;
  }
  void on_status(const lcm::ReceiveBuffer* buffer, const std::string&) {
    const auto* bytes = static_cast<const std::uint8_t*>(buffer->data);
    if (const auto s = drivers::decoded<history_status_t>({bytes, buffer->data_size})) {
      status_us = s->time_us;
      committed_us = s->summary_until_us;
      directory = s->directory;
    }
  }
};

std::string config_with_history(const test::TemporaryDirectory& directory) {
  const std::string path = directory.path("table.toml");
  test::write_file(path, test::read_file(test::table_config()) +
                             "\n[history]\ndirectory = \"h\"\nrotate_s = 7\n"
                             "summary_s = [1, 2, 4]\n");
  return path;
}

/// Returns the windows per shortest period, by its start.
std::map<std::int64_t, std::int64_t> committed(const std::string& directory, bool check) {
  SqliteFile file;
  EXPECT_TRUE(file.open_to_read(summary_file(directory))) << file.error();
  if (check) {
    SqliteStatement sound = file.prepare("PRAGMA integrity_check");
    EXPECT_TRUE(sound.row());
    EXPECT_EQ(sound.text(0), "ok");
  }
  std::map<std::int64_t, std::int64_t> out;
  SqliteStatement rows = file.prepare("SELECT start_us, windows FROM period WHERE period_s = 1");
  while (rows.row()) out[rows.integer(0)] = rows.integer(1);
  EXPECT_FALSE(file.failed()) << file.error();
  return out;
}

TEST(KillStorm, LosesAtMostASecondOfRawSamplesAndNothingCommitted) {
  if (const char* reason = std::getenv("FRAMEWATCH_NO_MULTICAST")) GTEST_SKIP() << reason;
  const test::TemporaryDirectory directory;
  const std::string config = config_with_history(directory), history = directory.path("h");
  std::string error;
  const auto lcm = drivers::open_lcm("udpm://239.255.76.67:7667?ttl=0", {}, error);
  if (!lcm) GTEST_SKIP() << error;
  Bus bus;
  lcm->subscribe("ACCEL", &Bus::on_sample, &bus)->setQueueCapacity(100'000);
  lcm->subscribe("FRAMEWATCH_HISTORY", &Bus::on_status, &bus);
  test::Child building({FRAMEWATCH_PROGRAM, "simulate",
                        FRAMEWATCH_SOURCE_DIR "/configs/scenario_table_two_story.toml", "--lcm",
                        "--seconds", std::to_string(8 * kills() + 60), "--quiet"});
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> life_s(1.2, 4.0);

  double worst_lost_s = 0, worst_restart_s = 0;
  std::map<std::int64_t, std::int64_t> before;
  for (int kill = 0; kill < kills(); ++kill) {
    const auto started = std::chrono::steady_clock::now();
    const std::int64_t started_us = host_clock_us();  // all samples of the daemon before are older
    test::Child daemon({FRAMEWATCH_PROGRAM, "run", config, "--quiet", "--state",
                        directory.path("state"), "--state-every", "1"});
    while (bus.status_us <= started_us && lcm->handleTimeout(10'000) > 0) {
    }
    const auto elapsed = [&] {
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    };
    ASSERT_GT(bus.status_us, started_us) << "no samples are recorded";
    worst_restart_s = std::max(worst_restart_s, elapsed());
    for (const double end_s = elapsed() + life_s(random); elapsed() < end_s;) lcm->handleTimeout(5);
    daemon.stop(SIGKILL);
    // Among other tests the daemon may be a second behind the bus, so its own status counts.
    const std::int64_t newest_us = kills() > kKills ? bus.newest_us - kOnTheWay_us : bus.status_us;

    const auto counts = test::raw_counts(history, newest_us - 60 * kSecond_us);
    ASSERT_FALSE(counts.empty());
    const double lost_s = 1e-6 * static_cast<double>(newest_us - counts.back().time_us);
    worst_lost_s = std::max(worst_lost_s, lost_s);
    EXPECT_LE(lost_s, kMaxLost_s) << "kill " << kill;

    const auto now = committed(history, true);
    for (const auto& [start_us, windows] : before) {
      const auto at = now.find(start_us);
      EXPECT_TRUE(at != now.end() && at->second >= windows) << "kill " << kill << ": " << start_us;
    }
    for (const auto& [start_us, windows] : now)
      EXPECT_LE(windows, 101) << "kill " << kill << ": counted twice";
    EXPECT_GE(now.empty() ? 0 : now.rbegin()->first + kSecond_us,
              bus.committed_us / kSecond_us * kSecond_us)
        << "kill " << kill << ": a committed period is missing";
    before = now;
  }
  EXPECT_LE(worst_restart_s, kills() > kKills ? kLongestRestart_s : kLongestAmongOthers_s);
  RecordProperty("worst_lost_ms", static_cast<int>(1e3 * worst_lost_s));
  RecordProperty("worst_restart_ms", static_cast<int>(1e3 * worst_restart_s));
  std::printf("%d kills: at most %.0f ms of raw samples lost, restart at most %.0f ms\n", kills(),
              1e3 * worst_lost_s, 1e3 * worst_restart_s);

  building.signal(SIGTERM);
  test::Child daemon({FRAMEWATCH_PROGRAM, "run", config, "--quiet"});
  for (bus.directory.clear(); bus.directory.empty() && lcm->handleTimeout(10'000) > 0;) {
  }
  EXPECT_TRUE(test::comes_true(
      [&] {
        int open = 0;
        for (const RawLog& log : raw_logs(raw_folder(history))) open += log.partial;
        return open <= 1;
      },
      std::chrono::seconds(10)))
      << "logs that were not closed are not repaired";
  EXPECT_EQ(daemon.stop(SIGTERM), 0);
  for (const RawLog& log : raw_logs(raw_folder(history))) EXPECT_FALSE(log.partial) << log.path;
}

}  // namespace history_kill_test
}  // namespace framewatch::daemon
