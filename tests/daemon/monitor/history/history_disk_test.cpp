// SPDX-License-Identifier: MIT
#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <framewatch/event_t.hpp>
#include <framewatch/history_status_t.hpp>

#include "daemon/base/sqlite_file.h"
#include "daemon/monitor/history/history_files.h"
#include "drivers/lcm/lcm_source.h"
#include "drivers/lcm/message_check.h"
#include "tests/support/child.h"
#include "tests/support/history_fixture.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace history_disk_test {

// Limits.
constexpr std::chrono::seconds kFull{40}, kWell{20};

/// The messages of the daemon on LCM.
struct Bus {
  history_status_t status{};
  std::vector<event_t> events;
  std::int64_t estimates = 0;
  void on_status(const lcm::ReceiveBuffer* buffer, const std::string&) {
    const auto* bytes = static_cast<const std::uint8_t*>(buffer->data);
    if (const auto s = drivers::decoded<history_status_t>({bytes, buffer->data_size})) status = *s;
  }
  void on_event(const lcm::ReceiveBuffer* buffer, const std::string&) {
    const auto* bytes = static_cast<const std::uint8_t*>(buffer->data);
    if (const auto e = drivers::decoded<event_t>({bytes, buffer->data_size})) events.push_back(*e);
  }
  void on_estimate(const lcm::ReceiveBuffer*, const std::string&) { ++estimates; }
  std::int64_t told(const char* place, int state) const {
    return std::count_if(events.begin(), events.end(), [&](const event_t& e) {
      return e.kind == "history" && e.place == place && e.state == state;
    });
  }
};

/// Returns true if this process may mount a file system.
bool may_mount() {
  test::Child child({"/bin/sh", "-c", "unshare -m mount -t tmpfs none /tmp 2>/dev/null"});
  return child.wait() == 0;
}

TEST(HistoryDisk, AFullDiskRaisesAnAlarmAndLosesNothingIfFreedInTime) {
  if (const char* reason = std::getenv("FRAMEWATCH_NO_MULTICAST")) GTEST_SKIP() << reason;
  if (!may_mount()) GTEST_SKIP() << "a small file system cannot be mounted here";
  std::string error;
  const auto lcm = drivers::open_lcm("udpm://239.255.76.67:7667?ttl=0", {}, error);
  if (!lcm) GTEST_SKIP() << error;
  Bus bus;
  lcm->subscribe("FRAMEWATCH_HISTORY", &Bus::on_status, &bus);
  lcm->subscribe("FRAMEWATCH_EVENT", &Bus::on_event, &bus);
  lcm->subscribe("FRAMEWATCH_ESTIMATE", &Bus::on_estimate, &bus)->setQueueCapacity(100'000);

  const test::TemporaryDirectory directory;
  const std::string disk = directory.path("disk"), config = directory.path("table.toml");
  std::filesystem::create_directory(disk);
  test::write_file(config, test::read_file(test::table_config()) +
                               "\n[history]\ndirectory = \"disk/h\"\nsummary_s = [1, 2, 4]\n"
                               "rotate_s = 20\n");
  test::Child daemon({"/bin/sh", "-c",
                      fmt::format("exec unshare -m sh -c 'mount -t tmpfs -o size=12m none {0} &&"
                                  " head -c 11500000 /dev/zero >{0}/ballast &&"
                                  " exec {1} run {2} --quiet 2>{3}'",
                                  disk, FRAMEWATCH_PROGRAM, config, directory.path("stderr"))});
  test::Child building({FRAMEWATCH_PROGRAM, "simulate",
                        FRAMEWATCH_SOURCE_DIR "/configs/scenario_table_two_story.toml", "--lcm",
                        "--seconds", "400", "--speed", "4", "--quiet"});
  const auto wait = [&](auto condition, std::chrono::seconds limit) {
    for (const auto until = std::chrono::steady_clock::now() + limit;
         !condition() && std::chrono::steady_clock::now() < until;)
      lcm->handleTimeout(100);
    return condition();
  };
  ASSERT_TRUE(wait([&] { return bus.told("raw", 1) > 0; }, kFull)) << bus.status.raw_samples;
  EXPECT_NE(bus.status.raw_trouble.find("No space left"), std::string::npos)
      << bus.status.raw_trouble;
  const std::int64_t estimates = bus.estimates;
  EXPECT_TRUE(wait([&] { return bus.estimates > estimates + 400; }, kWell))
      << "estimation continues";
  EXPECT_EQ(bus.told("raw", 1), 1) << "alarmed once";

  const std::string inside = fmt::format("/proc/{}/root{}", daemon.pid(), disk);
  std::filesystem::remove(inside + "/ballast");
  EXPECT_TRUE(
      wait([&] { return bus.told("raw", 0) > 0 && bus.status.summary_trouble.empty(); }, kWell));
  building.stop(SIGTERM);
  const std::int64_t samples = bus.status.raw_samples;
  EXPECT_EQ(bus.status.raw_dropped, 0);
  EXPECT_TRUE(test::comes_true(
      [&] { return static_cast<std::int64_t>(test::raw_counts(inside + "/h").size()) >= samples; },
      std::chrono::seconds(5)))
      << "waiting samples were not written";
  const std::string copy = directory.path("copy");
  std::filesystem::create_directory(copy);  // SQLite follows /proc/PID/root to this side's root
  for (const char* ending : {"", "-wal"})
    std::filesystem::copy_file(summary_file(inside + "/h") + ending, summary_file(copy) + ending);
  SqliteFile file;
  ASSERT_TRUE(file.open(summary_file(copy))) << file.error();
  SqliteStatement sound = file.prepare("PRAGMA integrity_check");
  ASSERT_TRUE(sound.row());
  EXPECT_EQ(sound.text(0), "ok");
  EXPECT_EQ(daemon.stop(SIGTERM), 0);
}

}  // namespace history_disk_test
}  // namespace framewatch::daemon
