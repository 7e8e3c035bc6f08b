// SPDX-License-Identifier: MIT
#include "daemon/tools/simulation/simulation.h"
#include "daemon/config/channel_addresses.h"

#include <chrono>
#include <cmath>

#include <gtest/gtest.h>
#include <lcm/lcm-cpp.hpp>

#include "daemon/tools/simulation/simulation_output.h"
#include "drivers/lcm/accel_codec.h"
#include "drivers/lcm/lcm_log.h"
#include "tests/support/paper_buildings.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace simulation_test {

Scenario small_scenario() {
  Scenario s;
  estimator::PipelineConfig& p = s.config.pipeline;
  p.structure = test::table1();
  p.axes = test::full_sensor_axes(p.structure);
  for (int i = 0; i < static_cast<int>(p.axes.size()); ++i)
    s.config.sources.push_back({"ACCEL", 1 + i / 2, i % 2});
  s.truth = test::table1_theta();
  s.motion = directed(estimator::kanai_tajimi({.duration_s = 2, .build_up_s = 0.1}), 0.5);
  s.sensors.assign(p.axes.size(), {.noise_density = 1e-4, .full_scale = 19.6133, .bits = 16});
  s.noise_ratio.assign(p.axes.size(), 0);
  s.duration_s = 2;
  return s;
}

bool store(const Scenario& s, const std::string& path) {
  std::string error;
  const auto output = file_output(s, path, error);
  EXPECT_TRUE(output) << error;
  if (!output) return false;
  Simulation simulation(s);
  for (std::int64_t i = 0; i < instants(s); ++i) {
    const auto& raw = simulation.next();
    if (!output->put(simulation.time_s(), raw)) return false;
  }
  return output->close();
}

TEST(Simulation, TheSameSeedGivesTheSameBytes) {
  const test::TemporaryDirectory directory;
  Scenario s = small_scenario();
  for (const char* suffix : {".csv", ".csv.gz", ".lcmlog"}) {
    ASSERT_TRUE(store(s, directory.path(std::string("a") + suffix)));
    ASSERT_TRUE(store(s, directory.path(std::string("b") + suffix)));
    const std::string a = test::read_file(directory.path(std::string("a") + suffix));
    EXPECT_GT(a.size(), 1000u);
    EXPECT_EQ(a, test::read_file(directory.path(std::string("b") + suffix)));
  }
  s.seed = 2;
  ASSERT_TRUE(store(s, directory.path("c.csv")));
  EXPECT_NE(test::read_file(directory.path("a.csv")), test::read_file(directory.path("c.csv")));
}

TEST(Simulation, SensorsFollowTheTemperatureOfTheClimate) {
  constexpr double kBiasPerDegc = 1e-3;
  Scenario s = small_scenario();
  s.climate.emplace();
  s.climate->climate.mean_degc = 50;  // midnight of a first of January is far colder
  for (estimator::SensorModel& m : s.sensors) m = {};
  Simulation right(s);
  s.sensors[3].bias_per_degc = kBiasPerDegc;
  Simulation cold(s);
  estimator::ClimateStream climate = climate_of(s);
  const double colder_degc = climate.next().outside_degc - 50;
  EXPECT_LT(colder_degc, -5);
  const double bias = cold.next()[3] - right.next()[3];
  EXPECT_NEAR(bias, kBiasPerDegc * colder_degc, 1e-9);
}

TEST(Simulation, TheLogHoldsEverySampleInOrder) {
  const test::TemporaryDirectory directory;
  const Scenario s = small_scenario();
  ASSERT_TRUE(store(s, directory.path("rec.lcmlog")));
  drivers::LcmLogReader reader;
  ASSERT_TRUE(reader.open(directory.path("rec.lcmlog"))) << reader.error();
  Simulation again(s);
  std::vector<double> expected;
  drivers::LogEvent event;
  ASSERT_EQ(reader.next(event), drivers::LogRead::event);
  EXPECT_EQ(event.channel, "ACCEL_CHANNELS");
  std::int64_t messages = 0;
  while (reader.next(event) == drivers::LogRead::event) {
    const auto sample = drivers::decode_accel(event.data.data(), event.data.size());
    ASSERT_TRUE(sample);
    const std::int64_t instant = messages / 11;
    if (messages % 11 == 0) expected = again.next();
    EXPECT_EQ(to_microseconds(sample->time), 10000 * instant);
    EXPECT_EQ(event.timestamp_us, 10000 * instant);
    EXPECT_EQ(sample->sequence, instant);
    const auto first = static_cast<std::size_t>(2 * (sample->node - 1));
    EXPECT_EQ(sample->accel_abs_mps2[0], expected[first]);
    EXPECT_EQ(sample->accel_abs_mps2[1], expected[first + 1]);
    EXPECT_TRUE(std::isnan(sample->accel_abs_mps2[2]));
    ++messages;
  }
  EXPECT_EQ(messages, 11 * 201);
}

void count_message(const lcm::ReceiveBuffer*, const std::string&, int* received) {
  ++*received;
}

TEST(Simulation, SendsLiveAtTheRequestedSpeed) {
  const Scenario s = small_scenario();
  lcm::LCM lcm("memq://");
  int samples = 0, tables = 0;
  lcm.subscribeFunction("ACCEL", &count_message, &samples);
  lcm.subscribeFunction("ACCEL_CHANNELS", &count_message, &tables);
  const auto output = live_output(s, lcm, 4);
  Simulation simulation(s);
  const auto before = std::chrono::steady_clock::now();
  for (int i = 0; i <= 120; ++i) {
    const auto& raw = simulation.next();
    ASSERT_TRUE(output->put(simulation.time_s(), raw));
  }
  const double took_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  EXPECT_GE(took_s, 0.3 - 1e-3);
  while (lcm.handleTimeout(0) > 0) {
  }
  EXPECT_EQ(samples, 121 * 11);
  EXPECT_EQ(tables, 2);
}

TEST(Simulation, AxesWithoutASourceGetNewNodes) {
  const auto at = addresses({{"", -1, 0}, {"ROOF", 7, 2}, {"", -1, 0}});
  EXPECT_EQ(at[0].node, 8);
  EXPECT_EQ(at[1].lcm_channel, "ROOF");
  EXPECT_EQ(at[1].node, 7);
  EXPECT_EQ(at[1].axis, 2);
  EXPECT_EQ(at[2].node, 9);
  EXPECT_EQ(at[2].lcm_channel, "ACCEL");
}

TEST(Simulation, RefusesAnUnknownFileFormat) {
  const test::TemporaryDirectory directory;
  std::string error;
  EXPECT_FALSE(file_output(small_scenario(), directory.path("rec.xlsx"), error));
  EXPECT_NE(error.find(".lcmlog"), std::string::npos);
  EXPECT_FALSE(file_output(small_scenario(), directory.path("no/rec.csv"), error));
  EXPECT_EQ(error, "No such file or directory");
  EXPECT_TRUE(directory.names().empty());
}

}  // namespace simulation_test
}  // namespace framewatch::daemon
