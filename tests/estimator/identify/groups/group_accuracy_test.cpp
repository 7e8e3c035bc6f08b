// SPDX-License-Identifier: MIT
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/tools/lab/few_sensors.h"
#include "estimator/identify/groups/layout_prediction.h"
#include "estimator/pipeline/pipeline.h"

namespace framewatch::estimator {
namespace group_accuracy_test {

using daemon::few_sensors_errors;
using daemon::FewSensorsErrors;
using daemon::tall_record;
using daemon::TallRecord;
using daemon::TallTrial;

FewSensorsErrors errors_of(TallTrial trial, int seeds) {
  FewSensorsErrors out;
  for (int seed = 1; seed <= seeds; ++seed) {
    trial.seed = static_cast<std::uint64_t>(seed);
    const FewSensorsErrors errors = few_sensors_errors(tall_record(trial), trial.from_s);
    out.stiffness.add(errors.stiffness);
    out.damping.add(errors.damping);
  }
  return out;
}

TEST(GroupAccuracy, IsLimitedByTheFiltersForExactMotion) {
  TallTrial trial;
  trial.noise_ratio = 0;
  TallRecord record = tall_record(trial);
  record.config.options.window_s = 20;
  const FewSensorsErrors errors = few_sensors_errors(record);
  ASSERT_GE(errors.stiffness.relative_error.size(), 4u * 5);
  EXPECT_LT(errors.stiffness.quantile(0.9), 2e-5);
  EXPECT_LT(errors.damping.quantile(0.9), 2e-4);
}

TEST(GroupAccuracy, MatchesTheoryForFourFloorsOfTwenty) {
  const FewSensorsErrors errors = errors_of({}, 3);
  EXPECT_LT(errors.stiffness.quantile(0.5), 0.0012);
  EXPECT_LT(errors.stiffness.quantile(0.95), 0.005);
  EXPECT_LT(errors.damping.quantile(0.5), 0.010);
  EXPECT_GT(errors.stiffness.published_ratio(), 0.99);
  EXPECT_GT(errors.stiffness.coverage_ratio(), 0.85);
}

TEST(GroupAccuracy, MatchesTheoryForRigidFloorsWithThreeChannels) {
  TallTrial trial;
  trial.in_space = true;
  trial.duration_s = 45;
  const FewSensorsErrors errors = errors_of(trial, 1);
  EXPECT_LT(errors.stiffness.quantile(0.5), 0.001);
  EXPECT_LT(errors.damping.quantile(0.5), 0.010);
  EXPECT_GT(errors.stiffness.coverage_ratio(), 0.85);
}

TEST(GroupAccuracy, FallsFivefoldWithFiveTimesTheNoise) {
  TallTrial trial;
  trial.noise_ratio = 0.05;
  const FewSensorsErrors errors = errors_of(trial, 3);
  EXPECT_LT(errors.stiffness.quantile(0.5), 0.006);
  EXPECT_LT(errors.damping.quantile(0.5), 0.05);
}

TEST(GroupAccuracy, IsReachedByRetuningForADoublyStiffBuilding) {
  TallTrial trial;
  trial.noise_ratio = 0.02;
  TallRecord record = tall_record(trial);
  record.config.design *= 0.5;
  const FewSensorsErrors errors = few_sensors_errors(record);
  EXPECT_LT(errors.stiffness.quantile(0.95), 0.01);
}

TEST(GroupAccuracy, NeedsTheBendingOfABendingBuilding) {
  TallTrial trial;
  trial.bending_nmprad = 3e12;
  trial.believed_bending_nmprad = 6e12;
  trial.duration_s = 90;
  trial.from_s = 50;  // the held bending stiffness has been found by then
  const FewSensorsErrors bending = errors_of(trial, 1);
  EXPECT_LT(bending.stiffness.quantile(0.9), 0.01);
  trial.believed_bending_nmprad = 0;
  EXPECT_GT(errors_of(trial, 1).stiffness.quantile(0.5), 0.03);
}

TEST(GroupAccuracy, IsPredictedFromTheDesign) {
  TallTrial trial;
  trial.stiffness_off = trial.damping_off = 0;
  std::vector<double> predicted(8, 0.0), measured(8, 0.0);
  constexpr int kSeeds = 4;
  double windows = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    trial.seed = static_cast<std::uint64_t>(seed);
    const TallRecord record = tall_record(trial);
    std::vector<double> noise;
    for (const SensorAxis& axis : record.config.axes) noise.push_back(axis.noise_density);
    ExpectedShaking shaking;
    shaking.rms_mps2 = std::sqrt(record.accel.col(0).array().square().mean());
    const LayoutPrediction p = predict_layout(record.config, noise, shaking);
    for (std::size_t i = 0; i < 8; ++i) predicted[i] += std::pow(p.window_error[i], 2) / kSeeds;
    for (const WindowEstimate& w : daemon::run_windows(record.config, record.accel, 20, 5)) {
      for (std::size_t i = 0; i < 8; ++i)
        measured[i] += std::pow(w.solution[i] / record.truth[static_cast<Eigen::Index>(i)] - 1, 2);
      ++windows;
    }
  }
  double stiffness = 0, damping = 0;
  for (std::size_t i = 0; i < 8; ++i)
    (i < 4 ? stiffness : damping) += std::log(predicted[i] / (measured[i] / windows)) / 8;
  EXPECT_NEAR(std::exp(stiffness), 1, 0.3);
  EXPECT_NEAR(std::exp(damping), 1, 0.3);
}

/// Returns the mean of every parameter over the windows from 20 s on.
Eigen::VectorXd mean_values(const PipelineConfig& config, const Eigen::MatrixXd& accel) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(config.parameters().size());
  const std::vector<WindowEstimate> windows = daemon::run_windows(config, accel, 20, 5);
  for (const WindowEstimate& w : windows)
    sum += Eigen::Map<const Eigen::VectorXd>(w.solution.data(), sum.size());
  return sum / static_cast<double>(windows.size());
}

TEST(GroupAccuracy, ErrorsOfGainAndTimeArePredicted) {
  // The predicted error may differ from the true one by a factor of kNear in groups with a large
  // error, and of kRough in the others.
  constexpr double kGain = 0.002, kTime_s = 1e-4, kNear = 1.3, kRough = 2.2;
  TallTrial trial;
  trial.floors = {5, 18, 19, 20};  // the last two move nearly alike
  trial.stiffness_off = trial.damping_off = 0;
  trial.noise_ratio = 1e-4;
  TallRecord record = tall_record(trial);
  record.config.options.self_tune = false;
  std::vector<double> noise;
  for (const SensorAxis& axis : record.config.axes) noise.push_back(axis.noise_density);
  const Eigen::Index rows = record.accel.rows();
  const double per_step = record.config.options.rate_hz / 2;
  for (const bool gain : {true, false}) {
    const Eigen::VectorXd right = mean_values(record.config, record.accel);
    Eigen::VectorXd squares = Eigen::VectorXd::Zero(right.size());
    for (Eigen::Index a = 0; a < record.accel.cols(); ++a) {
      Eigen::MatrixXd wrong = record.accel;
      if (gain)
        wrong.col(a) *= 1 + kGain;
      else  // the first term of a delay
        wrong.col(a).segment(1, rows - 2) +=
            kTime_s * per_step *
            (record.accel.col(a).tail(rows - 2) - record.accel.col(a).head(rows - 2));
      squares +=
          (mean_values(record.config, wrong).cwiseQuotient(right).array() - 1).matrix().cwiseAbs2();
    }
    const LayoutPrediction p =
        predict_layout(record.config, noise, {}, {}, {gain ? kGain : 0, gain ? 0 : kTime_s});
    for (std::size_t i = 0; i < 4; ++i) {
      const double found = std::sqrt(squares[static_cast<Eigen::Index>(i)]);
      const double factor = i < 2 ? kRough : kNear;
      EXPECT_LT(p.sensor_error[i], factor * found) << i;
      EXPECT_GT(p.sensor_error[i], found / factor) << i;
    }
  }
}

/// Returns the configuration of the record. `at_places`: the axes above the base are not on frames
/// but at the plan's origin.
PipelineConfig everywhere(const TallRecord& record, bool at_places) {
  PipelineConfig config = record.config;
  config.options.self_tune = false;
  if (!at_places) return config;
  config.options.corner_ratio /= 0.7;
  for (SensorAxis& axis : config.axes) {
    if (axis.story == 0) continue;
    axis.frame = -1;
    axis.plan = PlanPlace{};
  }
  return config;
}

TEST(GroupAccuracy, MatchesStoriesIfEveryFloorIsMeasured) {
  TallTrial trial;
  trial.stories = 5;
  trial.floors = {1, 2, 3, 4, 5};
  trial.stiffness_off = 0.05;
  trial.duration_s = 30;
  const TallRecord record = tall_record(trial);
  const PipelineConfig stories = everywhere(record, false), groups = everywhere(record, true);
  ASSERT_FALSE(stories.parameters().grouped());
  ASSERT_TRUE(groups.parameters().grouped());
  const auto of_stories = daemon::run_windows(stories, record.accel, 15, 1);
  const auto of_groups = daemon::run_windows(groups, record.accel, 15, 1);
  ASSERT_EQ(of_stories.size(), of_groups.size());
  ASSERT_GT(of_stories.size(), 5u);
  const ParameterTable table = stories.parameters(), same = groups.parameters();
  for (std::size_t w = 0; w < of_stories.size(); ++w)
    for (int p = 0; p < table.size(); ++p) {
      EXPECT_EQ(table[p].name, same[p].name);
      const auto i = static_cast<std::size_t>(p);
      EXPECT_NEAR(of_groups[w].solution[i] / of_stories[w].solution[i], 1, 1e-9) << table[p].name;
      // Errors of the design are drawn in another order.
      EXPECT_NEAR(of_groups[w].std_error[i] / of_stories[w].std_error[i], 1, 5e-3);
    }
}

}  // namespace group_accuracy_test
}  // namespace framewatch::estimator
