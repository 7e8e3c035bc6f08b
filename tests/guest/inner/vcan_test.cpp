// SPDX-License-Identifier: MIT
#include <atomic>
#include <chrono>
#include <optional>
#include <thread>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "drivers/can/can_encoder.h"
#include "tests/guest/inner/guest.h"

namespace framewatch::test {
namespace {

using Clock = std::chrono::steady_clock;

/// Nodes that count, 1 kHz each, as fast as a full bus of 1 Mbit/s.
TEST(Vcan, ASaturatedBusLosesNothing) {
  constexpr int kNodes = 8, kInstants = 6000;
  const Vcan vcan("vcan0");
  daemon::Config config = example_on("raw_int16", "vcan0");
  drivers::CanNodeMap node = config.can.nodes[0];
  config.can.nodes.clear();
  config.can.grid_period_us = node.period_us = 1000;
  for (int n = 0; n < kNodes; ++n) {
    node.messages[0].id = 0x181u + static_cast<std::uint32_t>(n);
    node.messages[0].readings.resize(1);
    node.messages[0].readings[0].axis = n % 2;
    config.can.nodes.push_back(node);
  }
  config.can.resample = false;
  drivers::CanIntake intake(config.can, [](const estimator::AccelSample&) {});
  drivers::CanSource source(config.can, false,
                            [&](int bus, const drivers::CanFrame& f) { intake.frame(bus, f); });
  ASSERT_TRUE(source.open().empty());
  std::atomic<bool> done = false;
  std::thread sender([&] {
    drivers::CanSocket socket;
    std::string error;
    if (!socket.open("vcan0", 4096, {{0x1FFFFFFF, 0x1FFFFFFF, true}}, false, error)) {
      ADD_FAILURE() << error;
    }
    drivers::CanEncoder encoder(config.can);
    auto due = Clock::now();
    for (int k = 0; k < kInstants; ++k, due += std::chrono::milliseconds(1)) {
      for (const drivers::BusFrame& f : encoder.instant({0.001 * k, -0.001 * k}))
        while (!socket.write(f.frame)) std::this_thread::yield();
      std::this_thread::sleep_until(due);
    }
    done = true;
  });
  const auto start = Clock::now();
  for (auto end = Clock::time_point::max(); Clock::now() < end;) {
    std::vector<pollfd> waiting;
    source.descriptors(waiting);
    ::poll(waiting.data(), waiting.size(), 20);
    source.handle(1);
    if (done && end == Clock::time_point::max())
      end = Clock::now() + std::chrono::milliseconds(300);
  }
  const std::chrono::duration<double> took = Clock::now() - start;
  sender.join();
  intake.finish();
  for (int n = 0; n < kNodes; ++n) {
    const drivers::CanNodeCounters c = intake.node(static_cast<std::size_t>(n));
    EXPECT_EQ(c.received, kInstants);
    EXPECT_EQ(c.lost, 0);
  }
  EXPECT_EQ(source.dropped(), 0);
  fmt::print("{} frames in {:.1f} s, 0 lost\n", kNodes * kInstants, took.count());
}

TEST(Vcan, AnInterfaceThatDisappearsLosesOnlyItsOwnFrames) {
  constexpr double kSeconds = 16;
  const Vcan vcan("vcan0");
  const daemon::Config config = example_on("tower", "vcan0");
  LiveBuses live(config);
  std::optional<Clock::time_point> start;  // of the traffic; a slow build needs seconds to start
  Process nodes({FRAMEWATCH_PROGRAM, "simulate", kTowerScenario, "--can", "vcan0", "--seconds",
                 fmt::format("{}", kSeconds), "--quiet"});
  int step = 0;
  std::size_t windows_before = 0;
  live.run([&] {
    if (!start && live.estimation.can().node(0).received > 0) start = Clock::now();
    const double t = start ? std::chrono::duration<double>(Clock::now() - *start).count() : 0;
    if (step == 0 && t > 3) shell("ip link set vcan0 down"), ++step;
    if (step == 1 && t > 3.5) shell("ip link set vcan0 up"), ++step;
    if (step == 2 && t > 5) vcan.down(), ++step;
    if (step == 3 && t > 6) vcan.up(), windows_before = live.estimates.size(), ++step;
    return nodes.ended();
  });
  EXPECT_EQ(step, 4);
  EXPECT_EQ(live.source.state(0).downs, 2);
  EXPECT_GT(live.estimates.size(), windows_before) << "estimation did not resume";
  const std::int64_t instants = static_cast<std::int64_t>(kSeconds) * 100 + 1;
  std::int64_t lost = 0;
  for (std::size_t n = 0; n < config.can.nodes.size(); ++n) {
    const drivers::CanNodeCounters c = live.estimation.can().node(n);
    EXPECT_EQ(c.received + c.lost, instants) << config.can.nodes[n].name;
    EXPECT_GT(c.lost, 0);  // the number depends on the load of the sender's processor
    lost += c.lost;
  }
  fmt::print("{} of {} frames lost while the interface was away, all counted\n", lost,
             instants * 18);
}

}  // namespace
}  // namespace framewatch::test
