// SPDX-License-Identifier: MIT
#include "estimator/simulate/sensor_model.h"

#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "tests/support/paper_buildings.h"

namespace framewatch::estimator {
namespace sensor_model_test {

constexpr std::uint64_t kSeed = 7;
constexpr double kRate_hz = 100;

struct Bench {
  Structure structure = test::table1();
  std::vector<SensorAxis> axes = test::full_sensor_axes(structure);
  std::vector<SensorModel> models{axes.size()};
  Eigen::VectorXd motion = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(axes.size()));

  /// Returns `count` samples of every axis, [sample][axis].
  std::vector<std::vector<double>> run(int count, std::uint64_t seed = kSeed) {
    SensorArray array(axes, models, kRate_hz, seed);
    std::vector<std::vector<double>> out;
    for (int i = 0; i < count; ++i) out.push_back(array.measure(i / kRate_hz, motion));
    return out;
  }
};

TEST(SensorModel, AnIdealSensorMeasuresTheMotion) {
  Bench b;
  for (Eigen::Index i = 0; i < b.motion.size(); ++i) b.motion[i] = static_cast<double>(i) - 7.5;
  const auto samples = b.run(1);
  for (std::size_t i = 0; i < b.axes.size(); ++i)
    EXPECT_EQ(samples[0][i], b.motion[static_cast<Eigen::Index>(i)]);
}

TEST(SensorModel, EveryAxisSensesItsPlace) {
  Bench b;
  b.axes[5].delay = 0.002;
  std::swap(b.axes[0], b.axes[20]);
  b.axes.push_back(b.axes[21]);
  b.axes.back().frame = 3;  // a base axis under a frame
  const auto channels = response_channels(b.structure, b.axes);
  ASSERT_EQ(channels.size(), 23u);
  EXPECT_EQ(channels[0].column, 20);
  EXPECT_EQ(channels[20].column, 0);
  EXPECT_EQ(channels[5].column, 5);
  EXPECT_EQ(channels[5].delay_s, 0.002);
  EXPECT_EQ(channels[21].column, 21);
  EXPECT_EQ(channels[22].column, 21);
}

TEST(SensorModel, NoiseHasItsDensityAndChannelsAreIndependent) {
  Bench b;
  for (SensorModel& m : b.models) m.noise_density = 2e-3;
  const int n = 20000;
  const auto samples = b.run(n);
  double mean = 0, square = 0, cross = 0, lag = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    mean += samples[i][0] / n;
    square += samples[i][0] * samples[i][0] / n;
    cross += samples[i][0] * samples[i][1] / n;
    if (i > 0) lag += samples[i][0] * samples[i - 1][0] / n;
  }
  const double sd = 2e-3 * std::sqrt(kRate_hz / 2);
  // Four standard errors of each statistic.
  EXPECT_NEAR(mean, 0, 4 * sd / std::sqrt(n));
  EXPECT_NEAR(square / (sd * sd), 1, 4 * std::sqrt(2.0 / n));
  EXPECT_NEAR(cross / (sd * sd), 0, 4 / std::sqrt(n));
  EXPECT_NEAR(lag / (sd * sd), 0, 4 / std::sqrt(n));
  EXPECT_NEAR(noise_density_of(0.01, 100 * sd, kRate_hz), 2e-3, 1e-15);
}

TEST(SensorModel, SamplesDependOnlyOnTheSeed) {
  Bench b;
  for (SensorModel& m : b.models) m.noise_density = 1e-3;
  EXPECT_EQ(b.run(50), b.run(50));
  EXPECT_NE(b.run(50), b.run(50, kSeed + 1));
  const auto before = b.run(50);
  b.models[3].bias = 1;
  b.models[3].loss_ratio = 0.5;
  const auto after = b.run(50);
  for (std::size_t i = 0; i < 50; ++i) EXPECT_EQ(before[i][4], after[i][4]);
}

TEST(SensorModel, BiasAndRampAddUp) {
  Bench b;
  b.models[0].bias = 0.05;
  b.models[0].thermal_ramp = 0.001;
  const auto samples = b.run(1001);
  EXPECT_NEAR(samples[0][0], 0.05, 1e-15);
  EXPECT_NEAR(samples[1000][0], 0.06, 1e-12);
}

TEST(SensorModel, FollowsItsTemperature) {
  constexpr double kWarmer_degc = 20;
  Bench b;
  b.models[0].bias_per_degc = 1e-3;
  b.models[1].gain_per_degc = -2e-4;
  SensorArray array(b.axes, b.models, 100, kSeed);
  const Eigen::VectorXd motion = Eigen::VectorXd::Constant(std::ssize(b.axes), 2);
  const auto raw = array.measure(0, motion, kWarmer_degc);
  EXPECT_NEAR(raw[0], 2 + 1e-3 * kWarmer_degc, 1e-12);
  EXPECT_NEAR(raw[1], 2 * (1 - 2e-4 * kWarmer_degc), 1e-12);
  EXPECT_NEAR(array.measure(0, motion)[1], 2, 1e-12);
}

TEST(SensorModel, QuantisesAndSaturates) {
  Bench b;
  b.models[0] = {.full_scale = 20, .bits = 16};
  const double lsb = 20 / 32768.0;
  b.motion[0] = 10.4 * lsb;
  EXPECT_DOUBLE_EQ(b.run(1)[0][0], 10 * lsb);
  b.motion[0] = 35;
  EXPECT_DOUBLE_EQ(b.run(1)[0][0], 20 - lsb);
  b.motion[0] = -35;
  EXPECT_DOUBLE_EQ(b.run(1)[0][0], -20);
  b.models[0].bits = 0;
  EXPECT_DOUBLE_EQ(b.run(1)[0][0], -20);
}

TEST(SensorModel, LosesItsShareAndIsDeadInItsTime) {
  Bench b;
  b.models[0].loss_ratio = 0.02;
  b.models[1].dead_from_s = 1;
  b.models[1].dead_to_s = 1.5;
  const int n = 20000;
  const auto samples = b.run(n);
  int lost = 0, dead = 0;
  for (const auto& s : samples) {
    lost += std::isnan(s[0]) ? 1 : 0;
    dead += std::isnan(s[1]) ? 1 : 0;
  }
  EXPECT_NEAR(lost, 0.02 * n, 4 * std::sqrt(0.02 * n));
  EXPECT_EQ(dead, 50);
  EXPECT_TRUE(std::isnan(samples[100][1]));
  EXPECT_FALSE(std::isnan(samples[150][1]));
}

TEST(SensorModel, CalibrationGivesTheMotionBack) {
  Bench b;
  b.axes[0].scale = 0.0024;
  b.axes[0].offset = 0.3;
  b.axes[0].polarity = -1;
  b.motion[0] = 1.25;
  const double raw = b.run(1)[0][0];
  EXPECT_NEAR(b.axes[0].polarity * (b.axes[0].scale * raw - b.axes[0].offset), 1.25, 1e-14);
}

TEST(SensorModel, RefusesImpossibleModels) {
  EXPECT_TRUE(problems(SensorModel{}).empty());
  EXPECT_EQ(problems({.bits = 16}).size(), 1u);
  EXPECT_EQ(problems({.noise_density = -1, .loss_ratio = 1}).size(), 2u);
  EXPECT_EQ(problems({.full_scale = 1, .bits = 1}).size(), 1u);
  EXPECT_EQ(problems({.dead_from_s = 2, .dead_to_s = 1}).size(), 1u);
}

}  // namespace sensor_model_test
}  // namespace framewatch::estimator
