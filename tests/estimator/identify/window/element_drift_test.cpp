// SPDX-License-Identifier: MIT
#include "estimator/identify/window/element_drift.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "estimator/numeric/nan.h"
#include "estimator/pipeline/pipeline.h"

namespace framewatch::estimator {
namespace element_drift_test {

constexpr double kRate_hz = 100, kHz = 5, kPeak_mps2 = 1, kBase_mps2 = 0.1;
/// Relative error of the rms deformation: the section is a double integrator well above its corner.
constexpr double kOff = 0.05;

/// A building whose lowest frequency is 2 Hz.
PipelineConfig two_stories() {
  PipelineConfig config;
  Structure& s = config.structure;
  s.stories = 2;
  s.frames_x = {"y1"};
  s.story_height = {3, 3};
  s.node_mass = {1000, 1000};
  config.design = Eigen::VectorXd::Constant(4, 1000 * std::pow(2 * M_PI * 2 / 0.618, 2));
  config.design.tail(2) *= 0.002;
  for (int story = 0; story <= 2; ++story) {
    config.axes.emplace_back();
    config.axes.back().name = "a" + std::to_string(story);
    config.axes.back().story = story;
    config.axes.back().frame = story > 0 ? 0 : -1;
    config.axes.back().noise_density = 1e-4;
  }
  config.options.hop_s = 0.5;
  return config;
}

/// Base and floors move with these peaks, m/s^2. lost: the axis that stops delivering after half
/// the time.
WindowEstimate last_of(const std::vector<double>& peaks, int lost = -1) {
  WindowEstimate last;
  const auto take = [&](const WindowEstimate& e) { last = e; };
  Pipeline pipeline(two_stories());
  for (int i = 0; i < 30 * kRate_hz; ++i)
    for (int a = 0; a < 3; ++a) {
      const double phase = std::sin(2 * M_PI * kHz * i / kRate_hz);
      const double accel = peaks[static_cast<std::size_t>(a)] * phase;
      const bool gone = a == lost && i > 15 * kRate_hz;
      each_main_window(pipeline.push({from_microseconds(10'000 * i), a, gone ? kNaN : accel}),
                       take);
    }
  each_main_window(pipeline.finish(), take);
  return last;
}

double rms_m(double accel_mps2) {
  return accel_mps2 / std::sqrt(2.0) / std::pow(2 * M_PI * kHz, 2);
}

TEST(ElementDrift, IsTheDisplacementBetweenTheEnds) {
  const WindowEstimate e =
      last_of({kBase_mps2, kBase_mps2 + kPeak_mps2, kBase_mps2 + 3 * kPeak_mps2});
  ASSERT_EQ(e.amplitude.size(), 4u);
  EXPECT_NEAR(e.amplitude[0] / rms_m(kPeak_mps2), 1, kOff);
  EXPECT_NEAR(e.amplitude[1] / rms_m(2 * kPeak_mps2), 1, kOff);
  EXPECT_TRUE(std::isnan(e.amplitude[2]));  // a damping has no amplitude
}

TEST(ElementDrift, IsUnknownWithoutAChannelThatShowsIt) {
  const WindowEstimate e = last_of({kBase_mps2, kBase_mps2 + kPeak_mps2, 3 * kPeak_mps2}, 2);
  EXPECT_NEAR(e.amplitude[0] / rms_m(kPeak_mps2), 1, kOff);
  EXPECT_TRUE(std::isnan(e.amplitude[1]));
}

}  // namespace element_drift_test
}  // namespace framewatch::estimator
