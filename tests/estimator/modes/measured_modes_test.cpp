// SPDX-License-Identifier: MIT
#include "estimator/modes/measured_modes.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/tools/lab/accuracy_trial.h"
#include "daemon/tools/lab/study_buildings.h"
#include "estimator/modes/mode_shapes.h"
#include "estimator/modes/natural_modes.h"
#include "estimator/simulate/ground_motion.h"
#include "estimator/simulate/random.h"
#include "tests/support/paper_buildings.h"

namespace framewatch::estimator {
namespace measured_modes_test {

constexpr double kRate_hz = 100;

/// 60 s of a building at 45 degrees with 1 % noise, and its true modes.
struct Shaken {
  std::vector<NaturalMode> exact;
  std::vector<ComparedMode> compared;  ///< the same at the channels
  std::vector<MeasuredMode> found;

  Shaken(const Structure& s, const Eigen::VectorXd& truth, std::uint64_t seed, double noise = 0.01)
      : exact(natural_modes(s, ParameterTable(s), {truth, {}}, truth).modes) {
    KanaiTajimi ground;
    ground.duration_s = 60;
    ground.strong_s = 45;
    ground.seed = seed;
    const daemon::ExactRecord record =
        daemon::exact_record(s, truth, directed(kanai_tajimi(ground), M_PI / 4), noise, 60);
    const Eigen::MatrixXd accel = daemon::with_noise(record, 7 * seed);
    found = measured_modes(recorded_motion(s, record.axes, kRate_hz, accel, 0, accel.rows()));
    const Eigen::MatrixXd weights = channel_weights(s, record.axes);
    for (const NaturalMode& mode : exact) {
      const auto own = static_cast<int>(compared.size());
      compared.push_back({mode.frequency_hz, weights * mode.shape, own, own});
    }
  }

  /// Returns the measured mode nearest to mode `at`.
  const MeasuredMode& of(std::size_t at) const {
    return *std::min_element(found.begin(), found.end(), [&](const auto& one, const auto& other) {
      return std::abs(one.frequency_hz - exact[at].frequency_hz) <
             std::abs(other.frequency_hz - exact[at].frequency_hz);
    });
  }
};

TEST(MeasuredModes, OfThePapersBuildingHaveItsThreeCloseLowestModes) {
  // 0.371, 0.390 and 0.419 Hz, 2 % damped: their half-power bands are 0.015 Hz wide
  constexpr double kHz = 0.005, kRatio = 0.15, kMac = 0.98;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Shaken shaken(test::table1(), test::table1_theta(), seed);
    ASSERT_GE(shaken.found.size(), 3u);
    for (const std::size_t i : {0u, 1u, 2u}) {
      const MeasuredMode& mode = shaken.of(i);
      EXPECT_NEAR(mode.frequency_hz, shaken.exact[i].frequency_hz,
                  kHz * shaken.exact[i].frequency_hz)
          << seed;
      EXPECT_NEAR(mode.damping_ratio, shaken.exact[i].damping_ratio,
                  kRatio * shaken.exact[i].damping_ratio)
          << seed;
      EXPECT_GT(mac(mode.shape, shaken.compared[i].shape), kMac) << seed;
    }
    for (std::size_t i = 1; i < shaken.found.size(); ++i)
      EXPECT_GE(shaken.found[i].frequency_hz, shaken.found[i - 1].frequency_hz);
  }
}

TEST(MeasuredModes, ApplyDelaysOfChannelsToTheShape) {
  // A floor whose samples come a quarter of a period late has a shape that is turned by it.
  constexpr double kHz = 2, kRatio = 0.02, kDelay_s = 0.125;
  RecordedMotion motion{kRate_hz, Eigen::MatrixXd(4000, 2), Eigen::MatrixXd(4000, 1),
                        Eigen::Vector2d(0, kDelay_s)};
  const double w = 2 * M_PI * kHz, damped = w * std::sqrt(1 - kRatio * kRatio);
  Random random(3);
  std::vector<double> pushes;
  for (Eigen::Index i = 0; i < 4000; ++i) {
    pushes.push_back(random.normal());
    motion.inputs(i, 0) = pushes.back();
  }
  const auto response = [&](double t) {
    double sum = 0;
    for (std::size_t k = 0; k < pushes.size(); ++k) {
      const double since = t - static_cast<double>(k) / kRate_hz;
      if (since >= 0 && since < 30)
        sum += pushes[k] * std::exp(-kRatio * w * since) * std::sin(damped * since);
    }
    return sum;
  };
  for (Eigen::Index i = 0; i < 4000; ++i) {
    const double t = static_cast<double>(i) / kRate_hz;
    motion.outputs(i, 0) = response(t) + 0.02 * random.normal();
    motion.outputs(i, 1) = 0.5 * response(t - kDelay_s) + 0.02 * random.normal();
  }
  const std::vector<MeasuredMode> found = measured_modes(motion);
  const auto mode = std::max_element(
      found.begin(), found.end(),
      [](const MeasuredMode& one, const MeasuredMode& other) { return one.orders < other.orders; });
  ASSERT_NE(mode, found.end());
  EXPECT_NEAR(mode->frequency_hz, kHz, 0.002 * kHz);
  EXPECT_NEAR(mode->damping_ratio, kRatio, 0.05 * kRatio);
  EXPECT_NEAR(mode->shape[0].real(), 1, 1e-12);
  EXPECT_NEAR(mode->shape[1].real(), 0.5, 0.05);
  EXPECT_NEAR(mode->shape[1].imag(), 0, 0.05);
}

TEST(MeasuredModes, OfAShortOrStillRecordAreNone) {
  const Eigen::VectorXd delay = Eigen::VectorXd::Zero(1);
  EXPECT_TRUE(measured_modes({kRate_hz, Eigen::MatrixXd::Ones(100, 1), {}, delay}).empty());
  EXPECT_TRUE(measured_modes({kRate_hz, Eigen::MatrixXd::Zero(5000, 1), {}, delay}).empty());
  EXPECT_TRUE(measured_modes({kRate_hz, Eigen::MatrixXd(0, 0), {}, {}}).empty());
  EXPECT_TRUE(measured_modes({0, Eigen::MatrixXd::Zero(5000, 1), {}, delay}).empty());
}

TEST(MeasuredModes, OfNoiseAloneAreHardlyAny) {
  Random random(11);
  RecordedMotion motion{kRate_hz, Eigen::MatrixXd(6000, 4), Eigen::MatrixXd(6000, 1),
                        Eigen::VectorXd::Zero(4)};
  for (Eigen::Index i = 0; i < 6000; ++i) {
    motion.inputs(i, 0) = random.normal();
    for (Eigen::Index c = 0; c < 4; ++c) motion.outputs(i, c) = random.normal();
  }
  EXPECT_LE(measured_modes(motion).size(), 2u);
}

}  // namespace measured_modes_test
}  // namespace framewatch::estimator
