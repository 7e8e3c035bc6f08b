#include "drivers/can/can_intake.h"

#include <cmath>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "drivers/can/can_log.h"
#include "tests/can/can_traffic.h"
#include "tests/support/data.h"

namespace framewatch::drivers {
namespace {

constexpr std::int64_t kStart_us = test::kTrafficStart_us;
constexpr double kWaveError_mps2 = 0.01;  ///< quantisation of the coarsest example is 0.01

using test::can_example;
using Traffic = std::vector<BusFrame>;

struct Result {
  std::map<std::pair<int, std::int64_t>, double> samples;  ///< by axis and microsecond
  std::vector<CanNodeCounters> nodes;
  std::vector<CanBusCounters> buses;
};

Result run(const CanMap& map, const Traffic& traffic) {
  Result out;
  CanIntake intake(map, [&](const AccelSample& s) {
    EXPECT_TRUE(out.samples.emplace(std::pair(s.axis, to_microseconds(s.time)), s.accel).second);
  });
  for (const BusFrame& f : traffic) intake.frame(f.bus, f.frame);
  intake.finish();
  for (std::size_t n = 0; n < map.nodes.size(); ++n) out.nodes.push_back(intake.node(n));
  out.buses = intake.buses();
  return out;
}

class Example : public testing::TestWithParam<const char*> {};

TEST_P(Example, GivesBackTheMotionAtTheRightTimes) {
  const daemon::Config config = can_example(GetParam());
  const double unit = std::abs(config.pipeline.axes[0].scale);
  const auto rate = static_cast<int>(config.pipeline.options.rate_hz);
  const Result result = run(config.can, test::can_traffic(config, 12 * rate, unit));
  ASSERT_EQ(result.nodes.size(), config.can.nodes.size());
  for (const CanNodeCounters& c : result.nodes) {
    EXPECT_NEAR(c.rate_hz() * config.can.nodes[0].samples_per_frame, rate, 1e-3 * rate);
    EXPECT_EQ(c.lost + c.duplicates + c.late + c.unplaced + c.wrong_length + c.wrong_kind, 0);
  }
  EXPECT_GT(result.samples.size(), 2u * 12 * static_cast<unsigned>(rate) - 60);
  // The frames came some fraction of a millisecond after the motion; latency and delay say so.
  const double slope = 2 * M_PI * 2.5;
  for (const auto& [at, value] : result.samples) {
    const double t_s = 1e-6 * static_cast<double>(at.second - kStart_us);
    EXPECT_NEAR(
        value * unit, test::can_wave(static_cast<std::size_t>(at.first), t_s),
        kWaveError_mps2 + slope * (config.can.nodes[0].samples_per_frame > 1 ? 0.012 : 0.002));
  }
}

INSTANTIATE_TEST_SUITE_P(Maps, Example,
                         testing::Values("raw_int16", "xsens_mti600", "sbg_ellipse", "bosch_mm510",
                                         "j1939_61485", "epson_m_a552", "fd_block", "tower"),
                         [](const auto& param) { return std::string(param.param); });

TEST(CanIntake, LatchedSamplesAllHaveTheTimeOfTheSync) {
  const daemon::Config config = can_example("tower");
  const Result result = run(config.can, test::can_traffic(config, 1000));
  EXPECT_EQ(result.samples.size(), 18u * 1000);
  std::map<std::int64_t, int> instants;
  for (const auto& [at, value] : result.samples) ++instants[at.second];
  EXPECT_EQ(instants.size(), 1000u);
  for (const auto& [time_us, axes] : instants) EXPECT_EQ(axes, 18);
  // SYNC was stamped 135 us after the instant, the nodes sample 500 us after it.
  EXPECT_EQ(instants.begin()->first, kStart_us + 135 + 500);
}

TEST(CanIntake, LostFramesAreCountedAndShiftNothing) {
  for (const char* name : {"tower", "raw_int16"}) {
    const daemon::Config config = can_example(name);
    Traffic all = test::can_traffic(config, 3000), some;
    std::mt19937 random(23);
    std::map<std::uint32_t, std::int64_t> dropped;
    for (const BusFrame& f : all) {
      const bool edge =
          f.frame.stamp_us < kStart_us + 1'000'000 || f.frame.stamp_us > kStart_us + 29'000'000;
      if (!edge && f.frame.id != 0x80 && random() % 20 == 0)
        ++dropped[f.frame.id];
      else
        some.push_back(f);
    }
    const Result whole = run(config.can, all), holes = run(config.can, some);
    for (std::size_t n = 0; n < config.can.nodes.size(); ++n)
      EXPECT_EQ(holes.nodes[n].lost, dropped[config.can.nodes[n].messages[0].id]) << name;
    for (const auto& [at, value] : holes.samples) {
      const auto same = whole.samples.find(at);
      ASSERT_NE(same, whole.samples.end()) << name;
      EXPECT_NEAR(value, same->second, config.can.resample ? 5e-3 : 0.0);
    }
  }
}

TEST(CanIntake, AFrameAfterTheNextSyncIsLateAndNotTheNextSample) {
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

/// The host stalls for 10 to 40 ms now and then: what came meanwhile is stamped at the end.
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

/// Without the microseconds by which the SYNC's line may differ.
std::map<std::pair<int, std::int64_t>, double> by_period(const Result& result) {
  std::map<std::pair<int, std::int64_t>, double> out;
  for (const auto& [at, value] : result.samples)
    out[{at.first, (at.second - kStart_us + 5'000) / 10'000}] = value;
  return out;
}

TEST(CanIntake, LateSyncsThatDoNotCountShiftNothing) {
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
    // Alone, a frame so long after its SYNC may be of the next one, lost.
    EXPECT_EQ(told.size() + static_cast<std::size_t>(dropped), right.size());
    EXPECT_EQ(dropped == 0, counting_nodes);
  }
}

/// The sender loses its processor at random, also within its first instant.
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

TEST(CanIntake, AStarvedSenderLosesNoSample) {
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

TEST(CanIntake, AnOutageThatEndsLateLosesWhatItLost) {
  constexpr int kInstants = 1000;
  constexpr std::int64_t kLost = 8, kFrame_us = 35;
  const daemon::Config config = can_example("tower");
  const Traffic good = test::can_traffic(config, kInstants);
  // More than half of what the SYNC counts to, 2.4 s: its own count is ambiguous.
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

TEST(CanIntake, TheNodesCountersTellWhichSyncWasLost) {
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
    if (!without) holes.push_back(f);  // the whole sample, also within a burst
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

TEST(CanIntake, BadFramesAreCountedAndDisturbNobody) {
  const daemon::Config config = can_example("tower");
  const Traffic good = test::can_traffic(config, 500);
  Traffic bad;
  std::mt19937 random(29);
  std::int64_t wrong_length = 0, wrong_kind = 0, foreign = 0, twice = 0;
  for (const BusFrame& f : good) {
    bad.push_back(f);
    BusFrame extra = f;
    ++extra.frame.stamp_us;
    switch (random() % 6) {
      case 0:
        if (f.frame.id == 0x80) break;
        extra.frame.length = static_cast<std::uint8_t>(random() % 8);
        ++wrong_length;
        bad.push_back(extra);
        break;
      case 1:
        if (f.frame.id == 0x80) break;
        extra.frame.fd = true;
        ++wrong_kind;
        bad.push_back(extra);
        break;
      case 2:
        for (int i = 0; i < 20; ++i) {
          extra.frame.id = static_cast<std::uint32_t>(0x200 + random() % 0x400);
          extra.frame.extended = random() % 2 == 0;
          ++foreign;
          bad.push_back(extra);
        }
        break;
      case 3:
        if (f.frame.id == 0x80) break;
        ++twice;
        bad.push_back(extra);
        break;
      case 4:
        extra.frame.remote = true;
        bad.push_back(extra);
        break;
      default:
        extra.frame.error = true;
        bad.push_back(extra);
    }
  }
  const Result a = run(config.can, good), b = run(config.can, bad);
  EXPECT_EQ(a.samples, b.samples);
  std::int64_t counted_length = 0, counted_kind = 0, counted_twice = 0;
  for (const CanNodeCounters& c : b.nodes) {
    counted_length += c.wrong_length;
    counted_kind += c.wrong_kind;
    counted_twice += c.duplicates;
    EXPECT_EQ(c.lost + c.late, 0);
  }
  EXPECT_EQ(counted_length, wrong_length);
  EXPECT_EQ(counted_kind, wrong_kind);
  EXPECT_EQ(counted_twice, twice);
  EXPECT_EQ(b.buses[0].foreign, foreign);
}

TEST(CanIntake, AClassicalFrameIsNoFdFrame) {
  const daemon::Config config = can_example("fd_block");
  Traffic t = test::can_traffic(config, 2000);
  for (std::size_t i = 0; i < t.size(); i += 5) {
    t[i].frame.fd = false;
    t[i].frame.length = 8;
  }
  const Result result = run(config.can, t);
  EXPECT_EQ(result.nodes[0].wrong_kind + result.nodes[1].wrong_kind, 80);
}

TEST(CanIntake, ABabblingNodeHurtsOnlyItself) {
  const daemon::Config config = can_example("raw_int16");
  const Traffic good = test::can_traffic(config, 1000);
  Traffic bad;
  for (const BusFrame& f : good) {
    bad.push_back(f);
    if (f.frame.id != 0x182) continue;
    for (int i = 1; i <= 10; ++i) {  // the same frame again and again
      bad.push_back(f);
      bad.back().frame.stamp_us += 200 * i;
    }
  }
  const Result a = run(config.can, good), b = run(config.can, bad);
  EXPECT_EQ(a.samples, b.samples);
  EXPECT_EQ(b.nodes[1].duplicates, 10 * b.nodes[1].received);
}

TEST(CanIntake, SeesBootUpAndEmergency) {
  const daemon::Config config = can_example("tower");
  Traffic t = test::can_traffic(config, 100);
  CanFrame boot;
  boot.id = 0x703;
  boot.length = 1;
  boot.stamp_us = kStart_us + 1'000'000;
  CanFrame emergency = boot;
  emergency.id = 0x083;
  emergency.length = 8;
  emergency.data = {0x10, 0x81};
  t.push_back({0, boot});
  t.push_back({0, emergency});
  const Result result = run(config.can, t);
  EXPECT_EQ(result.nodes[2].boot_ups, 1);
  EXPECT_EQ(result.nodes[2].emergencies, 1);
  EXPECT_EQ(result.nodes[2].last_emergency, 0x8110);
  EXPECT_EQ(result.buses[0].foreign, 0);
}

TEST(CanIntake, ErrorFramesTellTheBusState) {
  CanBusCounters c;
  CanFrame f;
  f.error = true;
  f.id = 0x204;
  f.data[1] = 0x04;
  count_error_frame(f, c);
  EXPECT_EQ(c.state, CanBusState::warning);
  f.data[1] = 0x10;
  count_error_frame(f, c);
  EXPECT_EQ(c.state, CanBusState::passive);
  f.id = 0x40;
  count_error_frame(f, c);
  EXPECT_EQ(c.state, CanBusState::off);
  f.id = 0x100;
  count_error_frame(f, c);
  EXPECT_EQ(c.state, CanBusState::active);
  EXPECT_EQ(c.bus_off, 1);
  EXPECT_EQ(c.restarted, 1);
  f.id = 0x4;
  f.data[1] = 0x01;
  count_error_frame(f, c);
  EXPECT_EQ(c.overflow, 1);
}

TEST(CanIntake, DecodesTheRealVehicle) {
  const auto log = test::data_path("can_real_vehicle_accel/can_sample.log");
  if (!log) GTEST_SKIP() << "no can_real_vehicle_accel in FRAMEWATCH_DATA";
  const CanField lateral{48, 8, true, true, CanValue::integer, 0.2, 0};
  const CanField longitudinal{56, 8, true, true, CanValue::integer, 0.15, 0};
  CanMap map;
  map.buses.push_back({});
  map.buses[0].interface = "can0";
  CanMessageMap message;
  message.id = 0xD0;
  message.mask = 0x7FF;
  message.length = 8;
  message.readings = {{lateral, 0, 0, "ACCEL_LAT"}, {longitudinal, 1, 0, "ACCEL_LONG"}};
  CanNodeMap node;
  node.messages = {message};
  node.period_us = 20000;
  map.nodes.push_back(node);
  std::vector<std::pair<double, double>> ours, theirs;
  std::vector<double> delays_us;
  std::vector<std::int64_t> stamps;
  std::vector<double> times;
  CanIntake intake(
      map, [](const AccelSample&) {},
      [&](const CanIntake::Decoded& d) {
        if (d.axis == 0) ours.push_back({d.value, 0});
        if (d.axis == 0) times.push_back(d.time_us);
        if (d.axis == 1) ours.back().second = d.value;
      });
  std::vector<Problem> problems;
  ASSERT_TRUE(read_candump(
      *log,
      [&](const CanFrame& f, std::string_view) {
        intake.frame(0, f);
        if (f.id != 0xD0) return;
        stamps.push_back(f.stamp_us);
        theirs.push_back({0.2 * static_cast<std::int8_t>(f.data[6]),
                          0.15 * static_cast<std::int8_t>(f.data[7])});
      },
      problems));
  intake.finish();
  ASSERT_EQ(ours.size(), 4514u);
  for (std::size_t i = 0; i < ours.size(); ++i) {
    EXPECT_DOUBLE_EQ(ours[i].first, theirs[i].first);
    EXPECT_DOUBLE_EQ(ours[i].second, theirs[i].second);
    EXPECT_NEAR(times[i], static_cast<double>(stamps[i]), 3000);
  }
  EXPECT_NEAR(intake.node(0).rate_hz(), 50.0, 0.01);
  EXPECT_EQ(intake.node(0).lost, 0);
  EXPECT_EQ(intake.buses()[0].frames, 82558);
  EXPECT_EQ(intake.buses()[0].foreign, 82558 - 4514);
}

}  // namespace
}  // namespace framewatch::drivers
