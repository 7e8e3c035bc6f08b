// SPDX-License-Identifier: MIT
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "daemon/monitor/live/intake_monitor.h"
#include "daemon/tools/session/recorder.h"
#include "daemon/tools/session/session_finish.h"
#include "daemon/tools/simulation/scenario.h"
#include "daemon/tools/simulation/simulation.h"
#include "drivers/can/bus_load.h"
#include "tests/support/can_traffic.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace record_can_test {

// Limits.
constexpr double kLoadError = 1e-9;

const std::string kTower = FRAMEWATCH_SOURCE_DIR "/configs/can/tower.toml";

TEST(RecordCan, StoresAndReportsFrames) {
  const Config config = test::can_example("tower");
  std::vector<ConfigProblem> problems;
  const auto scenario =
      load_scenario(FRAMEWATCH_SOURCE_DIR "/configs/can/scenario_tower.toml", problems);
  ASSERT_TRUE(scenario) << problems.front().message;
  const test::TemporaryDirectory directory;
  std::string folder;
  Recorder recorder(config, directory.path("sessions"),
                    [&](const std::string& ended) { folder = ended; });
  EXPECT_TRUE(recorder.channels().empty() || recorder.channels()[0].starts_with("FRAMEWATCH_"));
  Simulation simulation(*scenario);
  drivers::CanEncoder encoder(config.can);
  std::int64_t frames = 0, stored_from = 0;
  for (int k = 0; k < 1600; ++k) {
    const std::int64_t now_us = test::kTrafficStart_us + 10'000LL * k;
    if (k == 400) {
      EXPECT_TRUE(recorder.checked());
      EXPECT_EQ(recorder.begin({"CAN", "", ""}, now_us), "");
      stored_from = frames;
    }
    std::vector<double> values = simulation.next();
    std::map<int, int> on_bus;
    for (drivers::BusFrame& f : encoder.instant(values)) {
      f.frame.stamp_us = now_us + 135 + 270 * on_bus[f.bus]++;
      if (k == 800 && on_bus[f.bus] == 3) continue;  // lost on its way
      recorder.frame(f.bus, f.frame);
      ++frames;
    }
    recorder.tick(now_us);
  }
  EXPECT_EQ(recorder.stop("command", test::kTrafficStart_us + 16'000'000), "");
  recorder.tick(test::kTrafficStart_us + 17'000'000);
  std::ifstream log(folder + "/raw.can.log");
  std::int64_t lines = 0;
  for (std::string line; std::getline(log, line);) ++lines;
  EXPECT_EQ(lines, frames - stored_from);
  EXPECT_FALSE(std::filesystem::exists(folder + "/raw.lcmlog"));
  EXPECT_EQ(finish_session({kTower, folder, "", false, false, false, true, true}), 0);
  EXPECT_TRUE(std::filesystem::exists(folder + "/report.html"));
  std::string error;
  const auto session = read_session_file(folder + "/session.json", error);
  ASSERT_TRUE(session) << error;
  EXPECT_EQ(session->lost, 1);
  ASSERT_FALSE(session->stages.empty());
  EXPECT_EQ(session->stages[0].kind, StageKind::forced);
}

TEST(CanMonitor, ReportsRateAndLoadOfEveryFrameOnTheBus) {
  const Config config = test::can_example("tower");
  const drivers::CanBusMap& bus = config.can.buses[0];
  const test::TemporaryDirectory directory;
  const std::string at = directory.path(bus.interface + "/statistics");
  std::filesystem::create_directories(at);
  const auto count = [&](std::int64_t frames, std::int64_t bytes) {
    test::write_file(at + "/rx_packets", std::to_string(frames) + "\n");
    test::write_file(at + "/rx_bytes", std::to_string(bytes) + "\n");
    test::write_file(at + "/tx_packets", "100\n");
    test::write_file(at + "/tx_bytes", "0\n");
  };
  const drivers::CanIntake intake(config.can, [](const estimator::AccelSample&) {});
  const drivers::CanSource source(config.can, false, [](int, const drivers::CanFrame&) {});
  CanMonitor monitor(config, directory.path(""));
  count(5000, 40000);
  const auto first = monitor.collect(intake, source, 10'000'000);
  ASSERT_TRUE(first);
  EXPECT_TRUE(std::isnan(first->load[0]));
  EXPECT_EQ(first->state[0], -1);
  EXPECT_EQ(first->expected_load[0], drivers::bus_load(config.can, 0).share);
  EXPECT_FALSE(monitor.collect(intake, source, 10'900'000));
  count(7000, 56000);
  const auto second = monitor.collect(intake, source, 12'000'000);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->frames_hz[0], 1000);
  EXPECT_NEAR(second->load[0], 1000.0 * drivers::worst_classical_bits(8, false) / bus.bit_rate,
              kLoadError);
  count(10, 80);  // set up again
  EXPECT_TRUE(std::isnan(monitor.collect(intake, source, 13'000'000)->frames_hz[0]));
  std::filesystem::remove_all(at);
  EXPECT_TRUE(std::isnan(monitor.collect(intake, source, 14'000'000)->load[0]));
}

}  // namespace record_can_test
}  // namespace framewatch::daemon
