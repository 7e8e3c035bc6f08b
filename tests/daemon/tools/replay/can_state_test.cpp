// SPDX-License-Identifier: MIT
// The state of CAN is part of a saved state: a run that continues from it gives the same samples.
#include <algorithm>
#include <random>
#include <tuple>

#include <gtest/gtest.h>

#include "daemon/tools/replay/replay_command.h"
#include "drivers/can/can_intake.h"
#include "drivers/can/can_log.h"
#include "estimator/state/archive.h"
#include "tests/support/can_traffic.h"
#include "tests/support/temporary.h"

namespace framewatch::drivers {
namespace can_state_test {

constexpr int kInstants = 1500;
constexpr int kCuts = 40;

using Samples = std::vector<std::tuple<int, std::int64_t, double>>;

/// Losses, repeated, overtaken and late frames, outages, boot-ups.
std::vector<BusFrame> eventful(const daemon::Config& config, unsigned seed) {
  std::vector<BusFrame> out;
  std::mt19937 random(seed);
  std::int64_t stalled_until = 0;
  int lost_in_a_row = 0;
  for (const BusFrame& f : test::can_traffic(config, kInstants)) {
    BusFrame frame = f;
    if (random() % 1500 == 0) lost_in_a_row = 200;
    if (lost_in_a_row > 0 && --lost_in_a_row > 0) continue;
    if (random() % 40 == 0) continue;
    if (random() % 800 == 0) stalled_until = frame.frame.stamp_us + 35'000;
    frame.frame.stamp_us = std::max(frame.frame.stamp_us, stalled_until);
    out.push_back(frame);
    if (random() % 100 == 0) out.push_back(frame);
    if (out.size() > 1 && random() % 60 == 0) {
      std::swap(out.back().frame, out[out.size() - 2].frame);
      std::swap(out.back().frame.stamp_us, out[out.size() - 2].frame.stamp_us);
    }
    if (random() % 2000 == 0) {
      BusFrame boot{0, {}};
      boot.frame.id = 0x702;
      boot.frame.length = 1;
      boot.frame.stamp_us = frame.frame.stamp_us;
      out.push_back(boot);
    }
  }
  return out;
}

class CanState : public testing::TestWithParam<const char*> {};

TEST_P(CanState, ContinuesWithTheSamplesOfAnUninterruptedRun) {
  daemon::Config config = test::can_example(GetParam());
  if (config.can.nodes[0].timing == CanTiming::sync) config.can.buses[0].sync_overflow = 0;
  const std::vector<BusFrame> frames = eventful(config, 47);
  Samples samples;
  const auto sink = [&](const estimator::AccelSample& s) {
    samples.emplace_back(s.axis, to_microseconds(s.time), s.accel);
  };
  CanIntake uncut(config.can, sink);
  for (const BusFrame& f : frames) uncut.frame(f.bus, f.frame);
  uncut.finish();
  const Samples whole = std::exchange(samples, {});
  ASSERT_GT(whole.size(), 1000u);
  std::mt19937 random(53);
  for (int c = 0; c < kCuts; ++c) {
    const std::size_t cut = random() % frames.size();
    samples.clear();
    CanIntake first(config.can, sink);
    for (std::size_t i = 0; i < cut; ++i) first.frame(frames[i].bus, frames[i].frame);
    estimator::StateWriter writer;
    writer(first);
    CanIntake second(config.can, sink);
    estimator::StateReader reader(writer.bytes());
    reader(second);
    ASSERT_TRUE(reader.whole());
    for (std::size_t i = cut; i < frames.size(); ++i) second.frame(frames[i].bus, frames[i].frame);
    second.finish();
    ASSERT_EQ(samples, whole) << "cut at frame " << cut;
    for (std::size_t n = 0; n < config.can.nodes.size(); ++n) {
      estimator::StateWriter a, b;
      CanNodeCounters of_uncut = uncut.node(n), of_cut = second.node(n);
      a(of_uncut);
      b(of_cut);
      ASSERT_EQ(a.bytes(), b.bytes()) << "counters, cut at frame " << cut;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Maps, CanState,
                         testing::Values("raw_int16", "xsens_mti600", "bosch_mm510", "fd_block",
                                         "tower", "epson_m_a552"),
                         [](const auto& param) { return std::string(param.param); });

TEST(CanState, RefusesATruncatedState) {
  const daemon::Config config = test::can_example("tower");
  CanIntake intake(config.can, [](const estimator::AccelSample&) {});
  for (const BusFrame& f : test::can_traffic(config, 100)) intake.frame(f.bus, f.frame);
  estimator::StateWriter writer;
  writer(intake);
  std::vector<std::uint8_t> bytes = writer.bytes();
  bytes.resize(bytes.size() / 2);
  CanIntake other(config.can, [](const estimator::AccelSample&) {});
  estimator::StateReader reader(bytes);
  reader(other);
  EXPECT_FALSE(reader.good());
}

TEST(CanState, AReplayOfTwoPartsGivesTheBytesOfOne) {
  const std::string path = FRAMEWATCH_SOURCE_DIR "/configs/can/raw_int16.toml";
  const std::vector<BusFrame> frames = eventful(test::can_example("raw_int16"), 59);
  const test::TemporaryDirectory directory;
  const auto write = [&](const std::string& name, std::size_t from, std::size_t to) {
    CanLogWriter log;
    ASSERT_TRUE(log.open(directory.path(name)));
    for (std::size_t i = from; i < to; ++i) ASSERT_TRUE(log.write(frames[i].frame, "can0"));
    ASSERT_TRUE(log.close());
  };
  const std::size_t cut = frames.size() * 2 / 3;
  write("all.log", 0, frames.size());
  write("first.log", 0, cut);
  write("second.log", cut, frames.size());
  const auto replay = [&](const std::string& log, const std::string& out, const std::string& load,
                          const std::string& save) {
    daemon::ReplayArguments a{path, {directory.path(log)}, directory.path(out), false, true, false};
    a.one_pass = true;  // as parts are estimated
    if (!load.empty()) a.load_state = directory.path(load);
    if (!save.empty()) a.save_state = directory.path(save);
    return daemon::replay(a);
  };
  ASSERT_EQ(replay("all.log", "all.lcmlog", "", ""), 0);
  ASSERT_EQ(replay("first.log", "first.lcmlog", "", "state"), 0);
  ASSERT_EQ(replay("second.log", "second.lcmlog", "state", ""), 0);
  const std::string whole = test::read_file(directory.path("all.lcmlog"));
  EXPECT_GT(whole.size(), 10'000u);
  EXPECT_EQ(test::read_file(directory.path("first.lcmlog")) +
                test::read_file(directory.path("second.lcmlog")),
            whole);
}

}  // namespace can_state_test
}  // namespace framewatch::drivers
