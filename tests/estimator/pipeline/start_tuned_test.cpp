// SPDX-License-Identifier: MIT
// A pipeline with a given tuning loses no window to find it.
#include <algorithm>
#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "estimator/pipeline/pipeline.h"
#include "estimator/structure/natural_frequencies.h"
#include "tests/support/paper_buildings.h"
#include "tests/support/pipeline_run.h"

namespace framewatch::estimator {
namespace start_tuned_test {

constexpr int kRows = 500;  // of a whole window
constexpr double kRate_hz = 100, kSeconds = 25;
constexpr double kSoft = 0.4;       // design over truth
constexpr double kSooner_s = 1;     // speed-up at least, over a pipeline that must find its tuning
constexpr double kMaxError = 0.02;  // of a frame's stiffness in the first windows; noise 1 %

struct Tower {
  Tower() : structure(test::table1()), table(structure) {
    theta = with_proportional_damping(structure, table, test::table1_theta(), 0.02);
    accel = test::shaken(structure, theta, kRate_hz, kSeconds, 0.01);
    config = test::pipeline_config(structure);
    config.design = kSoft * theta;
  }
  Structure structure;
  ParameterTable table;
  Eigen::VectorXd theta;
  Eigen::MatrixXd accel;
  PipelineConfig config;
};

const Tower& tower() {
  static const Tower it;
  return it;
}

struct Seen {
  double first_s = 0;  ///< end of the first window with a value
  double worst = 0;    ///< error of a frame in the first whole one
  std::optional<Tuning> tuning;
};

Seen run(const std::optional<Tuning>& start) {
  const Tower& t = tower();
  Seen seen;
  const auto take = [&](const WindowEstimate& e) {
    if (e.status == WindowStatus::valid && seen.first_s == 0)
      seen.first_s = static_cast<double>(to_microseconds(e.end)) * 1e-6;
    if (e.rows < kRows || seen.worst > 0 || e.status != WindowStatus::valid) return;
    for (int p = 0; p < t.table.size(); ++p)
      if (const double v = e.value[static_cast<std::size_t>(p)];
          t.table[p].kind == ParameterKind::frame_stiffness && !std::isnan(v))
        seen.worst = std::max(seen.worst, std::abs(v / t.theta[p] - 1));
  };
  Pipeline pipeline(t.config);
  if (start) {
    pipeline.start_tuned(*start);
    EXPECT_EQ(pipeline.theta0(), start->theta0);
    EXPECT_EQ(pipeline.noise_density(), start->noise_density);
  }
  for (int i = 0; i < t.accel.rows(); ++i)
    for (int a = 0; a < t.accel.cols(); ++a)
      each_main_window(pipeline.push(test::sample_at(t.accel, kRate_hz, i, a)), take);
  each_main_window(pipeline.finish(), take);
  seen.tuning = pipeline.tuning();
  return seen;
}

TEST(StartTuned, PublishesFromTheFirstFullWindowOn) {
  const Seen first = run({});
  ASSERT_TRUE(first.tuning && first.tuning->found_right);
  const Seen second = run(first.tuning);
  EXPECT_LT(second.first_s, first.first_s - kSooner_s);
  EXPECT_LT(second.worst, kMaxError);
}

TEST(StartTuned, UnconfirmedTuningIsOnlyAStart) {
  Tuning start = *run({}).tuning;
  start.found_right = false;
  const Seen seen = run(start);
  EXPECT_TRUE(seen.tuning->found_right);
  start.found_right = true;
  EXPECT_LT(run(start).first_s, seen.first_s);
}

TEST(StartTuned, HasNoEffectWithoutSelfTuning) {
  PipelineConfig config = tower().config;
  config.options.self_tune = false;
  Pipeline pipeline(config);
  const Eigen::VectorXd before = pipeline.theta0();
  pipeline.start_tuned({2 * before, std::vector<double>(config.axes.size(), 1e-4)});
  EXPECT_EQ(pipeline.theta0(), before);
  EXPECT_FALSE(pipeline.tuning());
}

}  // namespace start_tuned_test
}  // namespace framewatch::estimator
