// SPDX-License-Identifier: MIT
#include "drivers/can/can_intake.h"

#include <cmath>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "drivers/can/can_log.h"
#include "drivers/can/can_source.h"
#include "tests/drivers/can/intake_run.h"
#include "tests/support/can_traffic.h"
#include "tests/support/data.h"

namespace framewatch::drivers {
namespace can_intake_test {

using test::can_example;

class Example : public testing::TestWithParam<const char*> {};

TEST_P(Example, ReproducesTheMotionAtTheRightTimes) {
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
  // The frames came a fraction of a millisecond after the motion, as latency and delay state.
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

TEST(CanIntake, PassesOnValuesThatStandByThemselves) {
  CanMap map;
  map.buses.emplace_back();
  CanField field;
  field.start = 0;
  field.bits = 16;
  field.factor = 0.01;
  CanMessageMap message;
  message.id = 512;
  message.mask = 0x7FF;
  message.length = 2;
  map.values.push_back({0, message, field, 7});
  EXPECT_FALSE(map.empty());
  const std::vector<CanFilter> filters = filters_of(map, 0);
  ASSERT_EQ(filters.size(), 1u);
  EXPECT_EQ(filters[0].id, 512u);
  CanIntake intake(map, [](const estimator::AccelSample&) { FAIL(); });
  std::vector<double> heard;
  intake.on_value([&](std::size_t covariate, double value, std::int64_t stamp_us) {
    EXPECT_EQ(covariate, 7u);
    EXPECT_EQ(stamp_us, kStart_us);
    heard.push_back(value);
  });
  CanFrame frame;
  frame.stamp_us = kStart_us;
  frame.id = 512;
  frame.length = 2;
  frame.data[0] = 0xE8;
  frame.data[1] = 0x03;
  intake.frame(0, frame);
  frame.length = 3;  // another message than the DBC file's
  intake.frame(0, frame);
  frame.length = 2;
  frame.id = 513;
  intake.frame(0, frame);
  ASSERT_EQ(heard.size(), 1u);
  EXPECT_NEAR(heard[0], 10, 1e-12);
  EXPECT_EQ(intake.buses()[0].foreign, 1);
}

TEST(CanIntake, CountsLostFramesWithoutShiftingOthers) {
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

TEST(CanIntake, CountsBadFramesWithoutDisturbingOthers) {
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

TEST(CanIntake, RejectsAClassicalFrameWhereAnFdFrameIsConfigured) {
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
    for (int i = 1; i <= 10; ++i) {  // repeats the same frame
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

TEST(CanIntake, ReadsTheBusStateFromErrorFrames) {
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
      map, [](const estimator::AccelSample&) {},
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

}  // namespace can_intake_test
}  // namespace framewatch::drivers
