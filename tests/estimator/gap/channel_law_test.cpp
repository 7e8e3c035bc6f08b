// SPDX-License-Identifier: MIT
// Every law is told from the others, with its number.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include "estimator/gap/channel_law.h"
#include "estimator/simulate/random.h"

namespace framewatch::estimator {
namespace channel_law_test {

constexpr double kRate_hz = 100;
constexpr int kInstants = 500;
constexpr double kNoise_mps2 = 1e-3;

/// Returns a motion of three modes, m/s^2, `late_s` later.
double motion(int axis, double time_s, double late_s = 0) {
  const double t = time_s - late_s, phase = axis;
  return 1.1 * std::sin(2 * std::numbers::pi * 1.7 * t + phase) +
         0.8 * std::cos(2 * std::numbers::pi * 4.3 * t + 2 * phase) +
         0.3 * std::sin(2 * std::numbers::pi * 9.1 * t + 3 * phase);
}

/// Three axes; `read(time_s)` replaces the reading of the first one.
ChannelReadings readings(const std::function<double(double)>& read) {
  ChannelReadings out{Eigen::MatrixXd(kInstants, 3), Eigen::MatrixXd(kInstants, 3), kRate_hz};
  Random random(5);
  for (int i = 0; i < kInstants; ++i)
    for (int axis = 0; axis < 3; ++axis) {
      out.expected(i, axis) = motion(axis, i / kRate_hz);
      out.read(i, axis) =
          (axis == 0 ? read(i / kRate_hz) : out.expected(i, axis)) + kNoise_mps2 * random.normal();
    }
  return out;
}

ChannelLaw law(const std::function<double(double)>& read) {
  return law_of(readings(read), 0);
}

TEST(ChannelLaw, NamesGainAndPolarity) {
  const ChannelLaw more = law([](double t) { return 1.1 * motion(0, t); });
  EXPECT_EQ(more.fault, ChannelFault::gain);
  EXPECT_NEAR(more.value, 1.1, 1e-3);
  const ChannelLaw turned = law([](double t) { return -motion(0, t); });
  EXPECT_EQ(turned.fault, ChannelFault::polarity);
  EXPECT_NEAR(turned.value, -1, 1e-3);
}

TEST(ChannelLaw, NamesDelayAndClock) {
  for (const double late_s : {0.0123, -0.031, 0.2}) {
    const ChannelLaw late = law([&](double t) { return motion(0, t, late_s); });
    EXPECT_EQ(late.fault, ChannelFault::late) << late_s;
    EXPECT_NEAR(late.value, late_s, 5e-4);
  }
  const ChannelLaw clock = law([](double t) { return motion(0, t, 2e-3 * t); });
  EXPECT_EQ(clock.fault, ChannelFault::clock);
  EXPECT_NEAR(clock.value, 2e-3, 1e-4);
}

TEST(ChannelLaw, NamesSaturationAndBandwidth) {
  const ChannelLaw soft = law([](double t) { return std::tanh(motion(0, t)); });
  EXPECT_EQ(soft.fault, ChannelFault::saturated);
  EXPECT_NEAR(soft.value, 1, 0.1);
  const ChannelLaw hard = law([](double t) { return std::clamp(motion(0, t), -0.7, 0.7); });
  EXPECT_EQ(hard.fault, ChannelFault::saturated);
  EXPECT_NEAR(hard.value, 0.7, 0.1);
  double state = motion(0, 0);
  const double share = 1 - std::exp(-2 * std::numbers::pi * 2 / kRate_hz);
  const ChannelLaw slow = law([&](double t) { return state += share * (motion(0, t) - state); });
  EXPECT_EQ(slow.fault, ChannelFault::bandwidth);
  EXPECT_NEAR(slow.value, 2, 0.4);
}

TEST(ChannelLaw, NamesTheOtherChannel) {
  const ChannelLaw repeats = law([](double t) { return motion(1, t); });
  EXPECT_EQ(repeats.fault, ChannelFault::repeats);
  EXPECT_EQ(repeats.other, 1);
  ChannelReadings both = readings([](double t) { return motion(2, t); });
  for (int i = 0; i < kInstants; ++i) both.read(i, 2) = motion(0, i / kRate_hz);
  const ChannelLaw exchanged = law_of(both, 0);
  EXPECT_EQ(exchanged.fault, ChannelFault::exchanged);
  EXPECT_EQ(exchanged.other, 2);
}

TEST(ChannelLaw, NamesNoiseAndWhatItDoesNotKnow) {
  EXPECT_EQ(law([](double) { return 0; }).fault, ChannelFault::only_noise);
  EXPECT_EQ(law([](double t) { return std::sin(40 * t) + std::cos(11 * t); }).fault,
            ChannelFault::unlike);
}

TEST(ChannelLaw, OfAnInputIsThatOfTheMotionWhichItCauses) {
  ChannelReadings of = readings([](double t) { return motion(0, t); });
  const Eigen::MatrixXd needed = of.read;
  of.expected = needed;
  of.read = 1.25 * needed;  // the base reads 25 % too much, and so the model moves
  const ChannelLaw gain = law_of_input(of);
  EXPECT_EQ(gain.fault, ChannelFault::gain);
  EXPECT_NEAR(gain.value, 1.25, 1e-6);

  constexpr int kLate = 3;  // instants
  of.read = needed;
  of.read.bottomRows(needed.rows() - kLate) = needed.topRows(needed.rows() - kLate);
  const ChannelLaw late = law_of_input(of);
  EXPECT_EQ(late.fault, ChannelFault::late);
  EXPECT_NEAR(late.value, kLate / kRate_hz, 0.05 / kRate_hz);
}

TEST(ChannelLaw, OfAnInputIsNoLawThatMakesTheFloorsVanish) {
  ChannelReadings of = readings([](double t) { return motion(0, t); });
  of.expected = 0.01 * of.expected.reverse();
  EXPECT_EQ(law_of_input(of).fault, ChannelFault::unlike);
}

}  // namespace channel_law_test
}  // namespace framewatch::estimator
