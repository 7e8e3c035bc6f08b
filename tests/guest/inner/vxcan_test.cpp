// SPDX-License-Identifier: MIT
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <fstream>
#include <map>
#include <set>
#include <thread>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "drivers/can/can_encoder.h"
#include "tests/guest/inner/guest.h"

namespace framewatch::test {
namespace {

using Clock = std::chrono::steady_clock;

/// A bus that loses, delays and reorders frames between vx0 and vx1.
struct BadBus {
  BadBus() {
    shell(
        "ip link add vx0 type vxcan peer name vx1 && ip link set vx0 up && ip link set vx1 up && "
        "tc qdisc add dev vx0 root netem delay 12ms 8ms loss 5% reorder 2% limit 10000");
  }
  void better() const {
    shell("tc qdisc change dev vx0 root netem delay 12ms 8ms loss 0.2% reorder 2% limit 10000");
  }
  ~BadBus() { shell("ip link del vx0"); }
  BadBus(const BadBus&) = delete;
  BadBus& operator=(const BadBus&) = delete;
};

TEST(Vxcan, PublishesNoWrongValueUnderLossReorderingAndJitter) {
  constexpr int kInstants = 2000;
  const BadBus bad_bus;
  const daemon::Config config = example_on("raw_int16", "vx1");
  const auto value = [](std::int64_t k) { return 0.001 * static_cast<double>(k * 7919 % 20000); };
  struct Seen {
    std::map<std::int64_t, double> value;
    std::int64_t first_counter = -1;
  };
  std::map<int, std::set<std::int64_t>> arrived;
  std::map<int, Seen> seen;
  drivers::CanIntake intake(
      config.can, [](const estimator::AccelSample&) {},
      [&](const drivers::CanIntake::Decoded& d) {
        EXPECT_TRUE(seen[d.node].value.emplace(d.number, d.value).second) << "twice";
      });
  drivers::CanSource source(config.can, false, [&](int bus, const drivers::CanFrame& f) {
    if (f.id == 0x181 || f.id == 0x182)
      arrived[static_cast<int>(f.id - 0x181)].insert(f.data[6] | f.data[7] << 8);
    intake.frame(bus, f);
  });
  ASSERT_TRUE(source.open().empty());
  std::atomic<bool> done = false;
  std::thread sender([&] {
    drivers::CanSocket socket;
    std::string error;
    if (!socket.open("vx0", 4096, {{0x1FFFFFFF, 0x1FFFFFFF, true}}, false, error)) {
      ADD_FAILURE() << error;
    }
    drivers::CanEncoder encoder(config.can);
    auto due = Clock::now();
    for (int k = 0; k < kInstants; ++k, due += std::chrono::milliseconds(10)) {
      for (const drivers::BusFrame& f : encoder.instant({value(k), -value(k)}))
        (void)socket.write(f.frame);
      std::this_thread::sleep_until(due);
    }
    done = true;
  });
  for (auto end = Clock::time_point::max(); Clock::now() < end;) {
    std::vector<pollfd> waiting;
    source.descriptors(waiting);
    ::poll(waiting.data(), waiting.size(), 20);
    source.handle(1);
    if (done && end == Clock::time_point::max())
      end = Clock::now() + std::chrono::milliseconds(300);
  }
  sender.join();
  intake.finish();
  std::int64_t lost = 0, reordered = 0;
  for (int n = 0; n < 2; ++n) {
    const drivers::CanNodeCounters c = intake.node(static_cast<std::size_t>(n));
    const auto& came = arrived[n];
    ASSERT_FALSE(came.empty());
    EXPECT_EQ(c.received, static_cast<std::int64_t>(came.size()));
    EXPECT_EQ(seen[n].value.size(), came.size());
    EXPECT_EQ(c.restarts, 0);
    // The numbers are counters with different starts.
    const std::int64_t shift = *came.begin() - seen[n].value.begin()->first;
    for (const auto& [number, v] : seen[n].value) {
      ASSERT_TRUE(came.contains(number + shift));
      EXPECT_NEAR(v, (n == 0 ? 1 : -1) * value(number + shift), 1e-9);
    }
    EXPECT_EQ(c.lost, *came.rbegin() - *came.begin() + 1 - static_cast<std::int64_t>(came.size()));
    lost += c.lost;
    reordered += c.reordered;
  }
  EXPECT_GT(lost, 100);
  EXPECT_GT(reordered, 10);
  fmt::print("{} frames: {} lost, {} overtaken; all counted, no value at a wrong time\n",
             2 * kInstants, lost, reordered);
}

/// At 5 % loss hardly any window is complete, at a fiftieth of that some are. Published values are
/// within their errors of the truth.
TEST(Vxcan, EstimatesOfALossyBusAreRightOrMissing) {
  constexpr double kStiffness_npm = 1.3e6, kSeconds = 24;
  constexpr double kErrors = 6, kLimit_ratio = 0.02;
  constexpr std::int64_t kEnoughLost = 40;
  const BadBus bad_bus;
  const std::string scenario = "/tmp/scenario_lossy.toml";
  std::ofstream(scenario) << "config = \"" FRAMEWATCH_SOURCE_DIR
                             "/configs/can/raw_int16.toml\"\n"
                             "duration_s = 60.0\nseed = 5\n[truth]\nkx_npm = [[1.3e6]]\n"
                             "damping_ratio = 0.03\n[motion]\npeak_mps2 = 2.0\n"
                             "ground_frequency_hz = 4.0\nground_damping_ratio = 0.6\n"
                             "high_pass_hz = 0.3\nbuild_up_s = 1.0\nstrong_s = 100000.0\n"
                             "length_s = 3600.0\n[sensors]\nnoise_mps2_per_rthz = 1e-4\n";
  const daemon::Config config = example_on("raw_int16", "vx1");
  LiveBuses live(config);
  Process nodes({FRAMEWATCH_PROGRAM, "simulate", scenario, "--can", "vx0", "--seconds",
                 fmt::format("{}", kSeconds), "--quiet"});
  const auto lost = [&] {
    return live.estimation.can().node(0).lost + live.estimation.can().node(1).lost;
  };
  bool bad = true;
  live.run([&] {
    if (bad && lost() > kEnoughLost) bad_bus.better(), bad = false;
    return nodes.ended();
  });
  std::int64_t published = 0;
  double worst = 0;
  for (const estimator::WindowEstimate& e : live.estimates) {
    if (e.reason[0] != estimator::Observability::observable) continue;
    ++published;
    const double error = std::abs(e.value[0] - kStiffness_npm);
    worst = std::max(worst, error / kStiffness_npm);
    EXPECT_LT(error, kErrors * e.std_error[0] + kLimit_ratio * kStiffness_npm);
  }
  EXPECT_GT(lost(), kEnoughLost);
  EXPECT_GT(published, 100);
  fmt::print("{} frames lost, {} of {} windows with a value, worst {:.2g} % off\n", lost(),
             published, live.estimates.size(), 100 * worst);
}

}  // namespace
}  // namespace framewatch::test
