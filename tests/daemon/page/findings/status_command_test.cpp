// SPDX-License-Identifier: MIT
#include "daemon/page/findings/status_command.h"

#include <framewatch/acknowledged_t.hpp>
#include <framewatch/history_status_t.hpp>
#include <framewatch/service_t.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <lcm/lcm-cpp.hpp>
#include <nlohmann/json.hpp>

#include "daemon/base/clocks.h"
#include "daemon/base/file_digest.h"
#include "daemon/base/process.h"
#include "daemon/monitor/events/event_messages.h"
#include "daemon/monitor/history/history_files.h"
#include "daemon/monitor/history/summary_store.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace status_command_test {

using namespace std::chrono_literals;

/// Returns a daemon's report that any process on the bus may have sent.
service_t forged() {
  service_t s{};
  s.time_us = s.started_us = host_clock_us();
  s.config = "/etc/\x1b]0;owned\x07";
  s.version = "1\x1b[2J";
  s.raised = 1;
  s.event_id = {7};
  s.event_since_us = {1};
  s.event_severity = {severity::alarm};
  s.event_kind = {"gap"};
  s.event_place = {"F1\xff"};
  s.event_message = {"they differ\n  systemd     active (running)\x1b[31m"};
  return s;
}

TEST(Status, PrintsNoForeignBytesToTheTerminal) {
  if (const char* reason = std::getenv("FRAMEWATCH_NO_MULTICAST")) GTEST_SKIP() << reason;
  std::atomic<bool> stop = false;
  std::thread sender([&] {
    lcm::LCM bus("udpm://239.255.76.67:7667?ttl=0");
    while (!stop) {
      const service_t s = forged();
      acknowledged_t known{};
      bus.publish("FRAMEWATCH_SERVICE", &s);
      bus.publish("FRAMEWATCH_ACKNOWLEDGED", &known);
      std::this_thread::sleep_for(100ms);
    }
  });
  for (const bool json : {false, true}) {
    StatusArguments arguments;
    arguments.config = test::table_config();
    arguments.json = json;
    testing::internal::CaptureStdout();
    EXPECT_EQ(status_command(arguments), 1);
    const std::string text = testing::internal::GetCapturedStdout();
    EXPECT_NE(text.find("The model does not fit: they differ\\n  systemd     active"),
              std::string::npos)
        << text;
    EXPECT_TRUE(std::none_of(text.begin(), text.end(), [](unsigned char c) {
      return (c < 0x20 && c != '\n') || c > 0x7e;
    })) << text;
  }
  stop = true;
  sender.join();
}

/// A healthy daemon whose history began 10 days ago.
class DiskStatusTest : public testing::Test {
 protected:
  DiskStatusTest() {
    const std::string folder = directory_.path("h");
    test::write_file(config_, test::read_file(test::table_config()) +
                                  "\n[history]\ndirectory = \"" + folder + "\"\n");
    HistorySettings settings;
    settings.directory = folder;
    settings.summary_s = {3600};
    SummaryStore store(settings);
    EXPECT_EQ(store.open(), "");
    SummaryBatch batch;
    batch.parameters.name = {"kx_1_y1"};
    batch.parameters.unit = {"N/m"};
    batch.parameters.kind = {0};
    batch.parameters.story = {1};
    PeriodData data;
    data.start_us = floor_to(host_clock_us(), 3600 * kSecond_us) - 10 * kDay_us;
    data.last_us = data.start_us + 1;
    data.windows = 1;
    data.parameters.resize(1);
    batch.periods.push_back(data);
    EXPECT_EQ(store.add(batch), "");
    sender_ = std::thread([this, folder] { send(folder); });
  }
  ~DiskStatusTest() override {
    stop_ = true;
    sender_.join();
  }
  void send(const std::string& folder) {
    lcm::LCM bus("udpm://239.255.76.67:7667?ttl=0");
    service_t s{};
    s.started_us = host_clock_us();
    s.version = FRAMEWATCH_VERSION;
    s.config = config_;
    s.config_sha256 = sha256_of_file(config_);
    s.disk_free_bytes = -1;
    history_status_t h{};
    h.directory = folder;
    h.stored_bytes = 1'500'000'000;
    h.disk_free_bytes = 2'500'000'000;
    while (!stop_) {
      s.time_us = s.received_us = host_clock_us();
      bus.publish("FRAMEWATCH_SERVICE", &s);
      bus.publish("FRAMEWATCH_HISTORY", &h);
      std::this_thread::sleep_for(100ms);
    }
  }
  /// Makes the history so large, without use of the disk, that 5.5 days remain at its growth.
  void fill() {
    const std::string folder = event_folder(directory_.path("h"));
    const std::string log = folder + "/20261120T000000Z.lcmlog.zst";
    std::filesystem::create_directories(folder);
    test::write_file(log, "");
    const auto free_bytes = static_cast<double>(disk_free_bytes(folder));
    std::filesystem::resize_file(log, static_cast<std::uint64_t>(free_bytes * 10 / 5.5));
  }
  std::string told(bool json, int code) {
    StatusArguments arguments;
    arguments.config = config_;
    arguments.json = json;
    testing::internal::CaptureStdout();
    EXPECT_EQ(status_command(arguments), code);
    return testing::internal::GetCapturedStdout();
  }

  const test::TemporaryDirectory directory_;
  const std::string config_ = directory_.path("table.toml");
  std::atomic<bool> stop_ = false;
  std::thread sender_;
};

TEST_F(DiskStatusTest, SaysWhenTheDiskIsFull) {
  if (const char* reason = std::getenv("FRAMEWATCH_NO_MULTICAST")) GTEST_SKIP() << reason;
  fill();
  const std::string text = told(false, 1);
  EXPECT_NE(text.find("1.5 GB in " + directory_.path("h") +
                      ", 0 samples lost to the disk, 2.5 GB free; the disk is full in about 5 days "
                      "(20"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("): free it, or lower history.keep_gb"), std::string::npos) << text;
  const auto json = nlohmann::json::parse(told(true, 1));
  EXPECT_NEAR(json["disk_full_in_days"].get<double>(), 5.5, 0.4);
  ASSERT_EQ(json["odd"].size(), 1u) << json["odd"];
  EXPECT_TRUE(json["odd"][0].get<std::string>().starts_with("the disk is full in about 5 days"));
}

TEST_F(DiskStatusTest, ASmallHistoryHasRoom) {
  if (const char* reason = std::getenv("FRAMEWATCH_NO_MULTICAST")) GTEST_SKIP() << reason;
  const std::string text = told(false, 0);
  EXPECT_NE(text.find("2.5 GB free; the disk has room for 10 years or more\n"), std::string::npos)
      << text;
  const auto json = nlohmann::json::parse(told(true, 0));
  ASSERT_TRUE(json.contains("disk_full_in_days"));
  EXPECT_TRUE(json["disk_full_in_days"].is_null());
}

}  // namespace status_command_test
}  // namespace framewatch::daemon
