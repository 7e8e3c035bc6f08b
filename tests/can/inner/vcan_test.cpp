#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>
#include <set>
#include <thread>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "daemon/scenario.h"
#include "daemon/simulation.h"
#include "drivers/accel_messages.h"
#include "drivers/can/can_encoder.h"
#include "tests/can/inner/guest.h"

namespace framewatch::test {
namespace {

using Clock = std::chrono::steady_clock;
constexpr const char* kScenario = FRAMEWATCH_SOURCE_DIR "/configs/can/scenario_tower.toml";

double tower_seconds() {
  const char* set = std::getenv("CAN_TEST_SECONDS");
  return set != nullptr ? std::atof(set) : 60;
}

struct Vcan {
  explicit Vcan(std::string name_) : name(std::move(name_)) { up(); }
  ~Vcan() { down(); }
  void up() const { shell("ip link add " + name + " type vcan && ip link set " + name + " up"); }
  void down() const { shell("ip link del " + name); }
  std::string name;
};

/// The scenario's samples, quantised as the bus does, over LCM messages.
std::vector<WindowEstimate> over_lcm(double seconds) {
  std::vector<daemon::ConfigProblem> problems;
  auto scenario = daemon::load_scenario(kScenario, problems);
  EXPECT_TRUE(scenario);
  scenario->duration_s = seconds;
  const drivers::CanMap map = scenario->config.can;
  const drivers::CanEncoder encoder(map);
  daemon::Config config = scenario->config;
  config.can = {};
  std::vector<std::string> names;
  std::vector<drivers::ChannelAddress> addresses;
  for (std::size_t a = 0; a < config.sources.size(); ++a) {
    config.sources[a] = {"ACCEL", static_cast<int>(a), 0};
    names.push_back(config.pipeline.axes[a].name);
    addresses.push_back({"ACCEL", static_cast<int>(a), 0});
  }
  std::vector<WindowEstimate> estimates;
  daemon::Estimation estimation(
      config, [](std::int64_t, const std::string&, const std::vector<std::uint8_t>&) {},
      [&](const WindowEstimate& e) { estimates.push_back(e); });
  drivers::AccelMessages messages(names, addresses, 100);
  daemon::Simulation simulation(*scenario);
  for (std::int64_t k = 0; k < daemon::instants(*scenario); ++k) {
    std::vector<double> values = simulation.next();
    for (std::size_t a = 0; a < values.size(); ++a)
      values[a] = encoder.quantised(static_cast<int>(a), values[a]);
    for (const drivers::Message& m : messages.samples(10'000 * k, values))
      estimation.message(m.channel, m.bytes.data(), m.bytes.size());
  }
  estimation.finish();
  return estimates;
}

bool same_bytes(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

TEST(Vcan, EighteenNodesLoseNothingAndEstimateAsOverLcm) {
  const double seconds = tower_seconds();
  const Vcan vcan("vcan0");
  const daemon::Config config = example_on("tower", "vcan0");
  LiveBuses live(config);
  Process nodes({FRAMEWATCH_PROGRAM, "simulate", kScenario, "--can", "vcan0", "--seconds",
                 fmt::format("{}", seconds), "--quiet"});
  live.run([&] { return nodes.ended(); });
  const auto instants = static_cast<std::int64_t>(std::floor(seconds * 100)) + 1;
  for (std::size_t n = 0; n < config.can.nodes.size(); ++n) {
    const drivers::CanNodeCounters c = live.estimation.can().node(n);
    EXPECT_EQ(c.received, instants) << config.can.nodes[n].name;
    EXPECT_EQ(c.lost + c.late + c.duplicates + c.unplaced, 0) << config.can.nodes[n].name;
  }
  EXPECT_EQ(live.source.dropped(), 0);
  const std::vector<WindowEstimate> expected = over_lcm(seconds);
  ASSERT_EQ(live.estimates.size(), expected.size());
  std::size_t different = 0, observable = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const WindowEstimate &a = live.estimates[i], &b = expected[i];
    different += !same_bytes(a.value, b.value) || !same_bytes(a.std_error, b.std_error) ||
                 a.reason != b.reason;
    for (const auto reason : b.reason) observable += reason == Observability::observable;
  }
  EXPECT_EQ(different, 0u);
  EXPECT_GT(observable, 0u);
  fmt::print("{} nodes x {} instants, 0 lost; {} windows, {} different, {} observable values\n",
             config.can.nodes.size(), instants, expected.size(), different, observable);
}

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
  drivers::CanSource* running = nullptr;
  drivers::CanIntake intake(config.can, [](const AccelSample&) {});
  drivers::CanSource source(config.can, false,
                            [&](int bus, const drivers::CanFrame& f) { intake.frame(bus, f); });
  running = &source;
  ASSERT_TRUE(running->open().empty());
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

TEST(Vcan, AnInterfaceThatGoesAndComesLosesWhatItLost) {
  constexpr double kSeconds = 16;
  const Vcan vcan("vcan0");
  const daemon::Config config = example_on("tower", "vcan0");
  LiveBuses live(config);
  const auto start = Clock::now();
  Process nodes({FRAMEWATCH_PROGRAM, "simulate", kScenario, "--can", "vcan0", "--seconds",
                 fmt::format("{}", kSeconds), "--quiet"});
  int step = 0;
  std::size_t windows_before = 0;
  live.run([&] {
    const double t = std::chrono::duration<double>(Clock::now() - start).count();
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
    EXPECT_GT(c.lost, 100);
    EXPECT_LT(c.lost, 400);
    lost += c.lost;
  }
  fmt::print("{} of {} frames lost while the interface was away, all counted\n", lost,
             instants * 18);
}

TEST(Vcan, TheDemoFindsItsStiffnessesOverCan) {
  const Vcan vcan("vcan0");
  Process demo({FRAMEWATCH_PROGRAM, "demo", "--can", "vcan0", "--seconds", "12", "--quiet"});
  while (!demo.ended()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
}

TEST(Vxcan, LossReorderingAndJitterPublishNothingWrong) {
  constexpr int kInstants = 2500;
  shell(
      "ip link add vx0 type vxcan peer name vx1 && ip link set vx0 up && ip link set vx1 up && "
      "tc qdisc add dev vx0 root netem delay 12ms 8ms loss 5% reorder 2% limit 10000");
  const daemon::Config config = example_on("raw_int16", "vx1");
  const auto value = [](std::int64_t k) { return 0.001 * static_cast<double>(k * 7919 % 20000); };
  struct Seen {
    std::map<std::int64_t, double> value;
    std::int64_t first_counter = -1;
  };
  std::map<int, std::set<std::int64_t>> arrived;
  std::map<int, Seen> seen;
  drivers::CanIntake intake(
      config.can, [](const AccelSample&) {},
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
    // Numbers are counters but for where they begin.
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
  fmt::print("of {} frames {} lost, {} overtaken: all told, no value at a wrong place\n",
             2 * kInstants, lost, reordered);
  shell("ip link del vx0");
}

}  // namespace
}  // namespace framewatch::test
