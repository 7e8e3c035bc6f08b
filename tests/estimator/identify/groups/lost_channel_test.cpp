// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "daemon/tools/lab/few_sensors.h"
#include "estimator/pipeline/pipeline.h"

namespace framewatch::estimator {
namespace lost_channel_test {

constexpr double kNoSample = std::numeric_limits<double>::quiet_NaN();

/// Returns the last estimate of the main window for the present samples.
WindowEstimate last_estimate(const PipelineConfig& config, const Eigen::MatrixXd& accel) {
  WindowEstimate last(static_cast<std::size_t>(config.parameters().size()));
  const auto take = [&](const WindowEstimate& estimate) { last = estimate; };
  Pipeline pipeline(config);
  for (Eigen::Index i = 0; i < accel.rows(); ++i)
    for (int a = 0; a < accel.cols(); ++a)
      if (std::isfinite(accel(i, a)))
        each_main_window(pipeline.push({from_microseconds(10'000 * i), a, accel(i, a)}), take);
  each_main_window(pipeline.finish(), take);
  return last;
}

/// The groups on both sides of the lost channel merge. They keep the ratio that was identified
/// while the channel was there, whatever the design's ratio was.
TEST(LostChannel, MakesItsFloorUnmeasured) {
  daemon::TallTrial trial;
  trial.duration_s = 60;
  daemon::TallRecord lost = daemon::tall_record(trial);
  lost.accel.col(2).tail(lost.accel.rows() - 2000).setConstant(kNoSample);
  const WindowEstimate last = last_estimate(lost.config, lost.accel);
  for (int p = 0; p < 4; ++p) {
    EXPECT_EQ(last.reason[static_cast<std::size_t>(p)], Observability::observable);
    EXPECT_NEAR(last.solution[static_cast<std::size_t>(p)] / lost.truth[p], 1, 0.01) << p;
  }
}

TEST(LostChannel, IsUsedAgainAfterItsReturn) {
  daemon::TallTrial trial;
  trial.duration_s = 90;
  daemon::TallRecord record = daemon::tall_record(trial);
  record.accel.col(3).segment(2000, 2500).setConstant(kNoSample);
  const WindowEstimate last = last_estimate(record.config, record.accel);
  for (int p = 0; p < 4; ++p) {
    EXPECT_EQ(last.reason[static_cast<std::size_t>(p)], Observability::observable);
    EXPECT_NEAR(last.solution[static_cast<std::size_t>(p)] / record.truth[p], 1, 0.01);
  }
}

TEST(LostChannel, OnlyRestartsTheFiltersIfBrief) {
  daemon::TallTrial trial;
  daemon::TallRecord record = daemon::tall_record(trial);
  record.accel.col(3).segment(2500, 20).setConstant(kNoSample);
  const WindowEstimate last = last_estimate(record.config, record.accel);
  EXPECT_EQ(last.reason[2], Observability::observable);
  EXPECT_NEAR(last.solution[2] / record.truth[2], 1, 0.01);
}

TEST(LostChannel, EndsAllEstimatesIfAtTheBase) {
  daemon::TallTrial trial;
  daemon::TallRecord record = daemon::tall_record(trial);
  record.accel.col(0).tail(3000).setConstant(kNoSample);
  const WindowEstimate last = last_estimate(record.config, record.accel);
  for (int p = 0; p < 8; ++p) EXPECT_TRUE(std::isnan(last.value[static_cast<std::size_t>(p)]));
}

}  // namespace lost_channel_test
}  // namespace framewatch::estimator
