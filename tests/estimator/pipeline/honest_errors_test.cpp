// SPDX-License-Identifier: MIT
// A window with samples that do not fit is never certain: no value is off by more than 3 % and by
// more than 5 of its standard errors, whatever the guard of the axes lets pass.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "estimator/pipeline/pipeline.h"
#include "estimator/structure/parameter_table.h"
#include "tests/support/paper_buildings.h"
#include "tests/support/pipeline_run.h"

namespace framewatch::estimator {
namespace honest_errors_test {

constexpr double kRate_hz = 100;
constexpr int kFirst = 2000, kApart = 1400;  // instants
constexpr double kWrong = 0.03, kErrors = 5;

/// Adds something, m/s^2, to the motion: accel(instant, axis), from `at` on.
using Spike = std::function<void(Eigen::MatrixXd& accel, int at)>;

/// Returns the share of the published frame stiffnesses that are wrong and certain.
double wrong_and_certain(const std::vector<Spike>& spikes, int first = kFirst) {
  const Structure building = test::table1();
  const Eigen::VectorXd truth = test::table1_theta();
  PipelineConfig config = test::pipeline_config(building, kRate_hz);
  config.options.hop_s = 0.05;
  const double seconds =
      (first + kApart * static_cast<double>(std::max<std::size_t>(spikes.size(), 4))) / kRate_hz;
  Eigen::MatrixXd accel = test::shaken(building, truth, kRate_hz, seconds, 0.001);
  for (std::size_t i = 0; i < spikes.size(); ++i)
    spikes[i](accel, first + kApart * static_cast<int>(i));
  const ParameterTable table(building);
  double wrong = 0, shown = 0;
  for (const WindowEstimate& e : test::run_pipeline(config, accel).estimates)
    for (int p = 0; p < table.size(); ++p) {
      const auto i = static_cast<std::size_t>(p);
      if (table[p].kind != ParameterKind::frame_stiffness || !std::isfinite(e.value[i])) continue;
      ++shown;
      const double off = std::abs(e.value[i] - truth[p]);
      if (off > kWrong * truth[p] && off > kErrors * e.std_error[i]) ++wrong;
    }
  EXPECT_GT(shown, 1000);
  return wrong / shown;
}

constexpr double kRare = 1e-3;  // share of the values

TEST(HonestErrors, CoverSpikesThatAGuardLetsPass) {
  std::vector<Spike> spikes;
  for (const double size : {2.0, 20.0, 150.0})  // another axis seems to confirm it
    spikes.push_back([size](Eigen::MatrixXd& accel, int at) {
      accel(at, 2) += size;
      accel(at, 5) += size / 10;
    });
  for (const int apart : {2, 3, 4})  // seems to ring
    spikes.push_back([apart](Eigen::MatrixXd& accel, int at) {
      for (const int t : {at, at + apart}) accel(t, 1) += 10;
    });
  spikes.push_back([](Eigen::MatrixXd& accel, int at) {  // seems to grow
    for (int t = 0; t < 7; ++t) accel(at + t, 3) += std::ldexp(2.0, t);
  });
  EXPECT_LE(wrong_and_certain(spikes), kRare);
}

/// Another gain leaves no more than noise does; ChannelCheck finds it.
TEST(HonestErrors, CoverAChannelThatFails) {
  constexpr int kLearned = 9000;  // instant
  constexpr int kAxis = 4, kOther = 5;
  const std::vector<Spike> faults{
      [](Eigen::MatrixXd& accel, int at) {  // only noise
        const auto rows = accel.rows() - at;
        accel.col(kAxis).tail(rows) = 1e-3 * Eigen::VectorXd::Random(rows);
      },
      [](Eigen::MatrixXd& accel, int at) {  // late by a sample
        const auto rows = accel.rows() - at;
        accel.col(kAxis).tail(rows) = accel.col(kAxis).segment(at - 1, rows).eval();
      },
      [](Eigen::MatrixXd& accel, int at) {  // exchanged
        const auto rows = accel.rows() - at;
        accel.col(kAxis).tail(rows).swap(accel.col(kOther).tail(rows));
      },
      [](Eigen::MatrixXd& accel, int at) {  // repeats another
        const auto rows = accel.rows() - at;
        accel.col(kAxis).tail(rows) = accel.col(kOther).tail(rows);
      }};
  for (std::size_t i = 0; i < faults.size(); ++i)
    EXPECT_LE(wrong_and_certain({faults[i]}, kLearned), kRare) << i;
}

TEST(HonestErrors, StaySmallWithoutSpikes) {
  EXPECT_EQ(wrong_and_certain({}), 0);
}

}  // namespace honest_errors_test
}  // namespace framewatch::estimator
