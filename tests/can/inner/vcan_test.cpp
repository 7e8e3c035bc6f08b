#include <atomic>
#include <chrono>
#include <thread>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "drivers/can/can_encoder.h"
#include "tests/can/inner/guest.h"

namespace framewatch::test {
namespace {

using Clock = std::chrono::steady_clock;

struct Vcan {
  explicit Vcan(std::string name_) : name(std::move(name_)) { up(); }
  ~Vcan() { down(); }
  void up() const { shell("ip link add " + name + " type vcan && ip link set " + name + " up"); }
  void down() const { shell("ip link del " + name); }
  std::string name;
};

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
  drivers::CanIntake intake(config.can, [](const AccelSample&) {});
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

}  // namespace
}  // namespace framewatch::test
