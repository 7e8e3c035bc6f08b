// SPDX-License-Identifier: MIT
#include "drivers/can/sync_matcher.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "tests/drivers/can/intake_run.h"
#include "tests/support/can_traffic.h"

// Passes whole buses, whose nodes sample at the SYNC, through CanIntake.
namespace framewatch::drivers {
namespace sync_matcher_test {

using test::can_example;

TEST(SyncMatcher, GivesLatchedSamplesTheTimeOfTheSync) {
  const daemon::Config config = can_example("tower");
  const Result result = run(config.can, test::can_traffic(config, 1000));
  EXPECT_EQ(result.samples.size(), 18u * 1000);
  std::map<std::int64_t, int> instants;
  for (const auto& [at, value] : result.samples) ++instants[at.second];
  EXPECT_EQ(instants.size(), 1000u);
  for (const auto& [time_us, axes] : instants) EXPECT_EQ(axes, 18);
  // The SYNC is stamped 135 us after the instant; the nodes sample 500 us after the SYNC.
  EXPECT_EQ(instants.begin()->first, kStart_us + 135 + 500);
}

TEST(SyncMatcher, CountsAFrameAfterTheNextSyncAsLate) {
  const daemon::Config config = can_example("tower");
  Traffic t = test::can_traffic(config, 200);
  // Node 3's frame of instant 100 comes after SYNC 101, before its own frame of instant 101.
  const std::uint32_t id = config.can.nodes[2].messages[0].id;
  auto at = std::find_if(t.begin(), t.end(), [&](const BusFrame& f) {
    return f.frame.id == id && f.frame.stamp_us >= kStart_us + 1'000'000;
  });
  BusFrame late = *at;
  t.erase(at);
  at = std::find_if(t.begin(), t.end(), [&](const BusFrame& f) {
    return f.frame.id == 0x80 && f.frame.stamp_us >= kStart_us + 1'010'000;
  });
  late.frame.stamp_us = at->frame.stamp_us + 100;
  t.insert(at + 1, late);
  const Result result = run(config.can, t), whole = run(config.can, test::can_traffic(config, 200));
  EXPECT_EQ(result.nodes[2].late, 1);
  EXPECT_EQ(result.nodes[2].lost, 1);
  EXPECT_EQ(result.samples.size() + 1, whole.samples.size());
  for (const auto& [place, value] : result.samples) EXPECT_EQ(value, whole.samples.at(place));
}

/// The host stalls for 10 to 40 ms at times and stamps the frames of that time at its end.
Traffic stalled(Traffic t) {
  std::mt19937 random(41);
  std::uniform_int_distribution<std::int64_t> length_us(10'000, 40'000), apart_us(200'000, 700'000);
  std::int64_t begin = kStart_us + 30'000, end = begin + length_us(random), last = 0;
  for (BusFrame& f : t) {
    std::int64_t& stamp = f.frame.stamp_us;
    while (stamp > end) {
      begin = end + apart_us(random);
      end = begin + length_us(random);
    }
    if (stamp > begin) stamp = end;
    last = stamp = std::max(stamp, last + 20);
  }
  return t;
}

/// Returns the samples by axis and period, so that small differences in their times do not count.
std::map<std::pair<int, std::int64_t>, double> by_period(const Result& result) {
  std::map<std::pair<int, std::int64_t>, double> out;
  for (const auto& [at, value] : result.samples)
    out[{at.first, (at.second - kStart_us + 5'000) / 10'000}] = value;
  return out;
}

TEST(SyncMatcher, LateSyncsWithoutACounterShiftNothing) {
  for (const bool counting_nodes : {true, false}) {
    daemon::Config config = can_example("tower");
    config.can.buses[0].sync_overflow = 0;
    for (CanNodeMap& node : config.can.nodes)
      if (!counting_nodes) node.messages[0].counter.reset();
    const Traffic good = test::can_traffic(config, 6000);
    const Result whole = run(config.can, good), late = run(config.can, stalled(good));
    EXPECT_EQ(whole.samples.size(), 18u * 6000);
    const auto right = by_period(whole), told = by_period(late);
    for (const auto& [at, value] : told) EXPECT_EQ(value, right.at(at));
    std::int64_t dropped = 0;
    for (const CanNodeCounters& c : late.nodes) {
      EXPECT_EQ(c.received + c.lost, 6000);
      EXPECT_EQ(c.duplicates + c.unplaced, 0);
      EXPECT_EQ(c.lost, c.late);
      dropped += c.late;
    }
    // Without other frames, one so long after its SYNC may belong to the next SYNC, which was lost.
    EXPECT_EQ(told.size() + static_cast<std::size_t>(dropped), right.size());
    EXPECT_EQ(dropped == 0, counting_nodes);
  }
}

/// The sender is interrupted at random, also within its first instant.
Traffic starved(Traffic t, unsigned seed) {
  constexpr double kStall_us = 40'000, kApart_us = 200'000, kFrame_us = 35;
  std::mt19937 random(seed);
  std::exponential_distribution<double> stall(1 / kStall_us), apart(1 / kApart_us);
  double now_us = 0, next_us = seed % 2 == 0 ? 0.02 * apart(random) : apart(random);
  for (BusFrame& f : t) {
    now_us = std::max(static_cast<double>(f.frame.stamp_us - kStart_us), now_us + kFrame_us);
    if (now_us >= next_us) {
      now_us += stall(random);
      next_us = now_us + apart(random);
    }
    f.frame.stamp_us = kStart_us + std::llround(now_us);
  }
  return t;
}

TEST(SyncMatcher, AStarvedSenderLosesNoSample) {
  constexpr int kInstants = 500;
  const daemon::Config config = can_example("tower");
  const Traffic good = test::can_traffic(config, kInstants);
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const Result result = run(config.can, starved(good, seed));
    for (const CanNodeCounters& c : result.nodes) {
      EXPECT_EQ(c.received, kInstants) << seed;
      EXPECT_EQ(c.lost + c.late + c.duplicates + c.unplaced, 0) << seed;
    }
    std::map<std::int64_t, int> instants;
    for (const auto& [at, value] : result.samples) {
      ++instants[at.second];
      const auto k = std::llround(
          1e-4 * static_cast<double>(at.second - result.samples.begin()->first.second));
      EXPECT_NEAR(value,
                  test::can_wave(static_cast<std::size_t>(at.first), 0.01 * static_cast<double>(k)),
                  kWaveError_mps2)
          << seed;
    }
    EXPECT_EQ(instants.size(), static_cast<std::size_t>(kInstants)) << seed;
  }
}

TEST(SyncMatcher, AnOutageThatEndsLateLosesOnlyItsOwnSamples) {
  constexpr int kInstants = 1000;
  constexpr std::int64_t kLost = 8, kFrame_us = 35;
  const daemon::Config config = can_example("tower");
  const Traffic good = test::can_traffic(config, kInstants);
  // More than half the range of the SYNC counter (2.4 s), so that its count alone is ambiguous.
  for (const std::int64_t late_us : {350'000, 1'270'000, 1'900'000, 2'400'000, 4'700'000}) {
    const std::int64_t end_us = kStart_us + 4'080'000 + late_us;
    Traffic left;
    for (BusFrame f : good) {
      const std::int64_t instant = (f.frame.stamp_us - kStart_us) / 10'000;
      if (instant >= 400 && instant < 400 + kLost) continue;
      if (instant >= 400 + kLost)
        f.frame.stamp_us =
            std::max({f.frame.stamp_us, end_us, left.back().frame.stamp_us + kFrame_us});
      left.push_back(f);
    }
    const Result result = run(config.can, left);
    for (const CanNodeCounters& c : result.nodes) {
      EXPECT_EQ(c.received, kInstants - kLost) << late_us;
      EXPECT_EQ(c.lost, kLost) << late_us;
      EXPECT_EQ(c.late + c.duplicates + c.unplaced, 0) << late_us;
    }
    const auto whole = by_period(run(config.can, good));
    for (const auto& [at, value] : by_period(result)) EXPECT_EQ(value, whole.at(at)) << late_us;
  }
}

TEST(SyncMatcher, FindsTheLostSyncByTheNodesCounters) {
  daemon::Config config = can_example("tower");
  config.can.buses[0].sync_overflow = 0;
  const Traffic good = test::can_traffic(config, 6000);
  Traffic holes;
  std::mt19937 random(43);
  std::int64_t syncs = 0, lost = 0;
  bool without = false;
  for (const BusFrame& f : stalled(good)) {
    if (f.frame.id == 0x80) {
      without = ++syncs > 100 && syncs < 5990 && random() % 40 == 0;
      lost += without;
    }
    if (!without) holes.push_back(f);  // drops whole samples, also within a burst
  }
  const auto whole = by_period(run(config.can, good));
  const Result result = run(config.can, holes);
  EXPECT_EQ(result.samples.size(), 18u * static_cast<std::size_t>(6000 - lost));
  for (const auto& [at, value] : by_period(result)) EXPECT_EQ(value, whole.at(at));
  for (const CanNodeCounters& c : result.nodes) {
    EXPECT_EQ(c.lost, lost);
    EXPECT_EQ(c.late + c.duplicates + c.unplaced, 0);
  }
}

}  // namespace sync_matcher_test
}  // namespace framewatch::drivers
