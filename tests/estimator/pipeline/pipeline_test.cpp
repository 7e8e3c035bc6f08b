// SPDX-License-Identifier: MIT
#include "estimator/pipeline/pipeline.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "estimator/structure/natural_frequencies.h"
#include "tests/support/paper_buildings.h"
#include "tests/support/pipeline_run.h"

namespace framewatch::estimator {
namespace pipeline_test {

using test::PipelineRun;
using test::run_pipeline;

/// Instants until filters are refilled after the start: at least the triple's taps.
constexpr int kTriple = 15;
constexpr int kWindow = 500;
/// Rows needed for a first value: four blocks of the window, a second.
constexpr int kWarmUp = 100;

/// Two stories, 1x1 bay, eccentric: small and quick.
Structure small() {
  Structure s = test::table1();
  s.stories = 2;
  s.story_height.resize(2);
  s.node_mass.resize(8);
  return s;
}

Eigen::VectorXd small_theta() {
  const Structure s = small();
  const ParameterTable table(s);
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(table.size());
  theta.head(table.elements()) << 35e5, 20e5, 30e5, 25e5, 20e5, 30e5, 30e5, 20e5, 25e4, 23e4;
  return with_proportional_damping(s, table, theta, 0.02);
}

const Eigen::MatrixXd& small_accel() {
  static const Eigen::MatrixXd accel = test::shaken(small(), small_theta(), 100, 25, 0.01);
  return accel;
}

PipelineConfig small_config() {
  PipelineConfig config = test::pipeline_config(small());
  config.design = small_theta();
  return config;
}

/// Rows that a start in motion costs per equation.
constexpr int kShapes = 4;

/// Instants until rows are weighted by the measured noise.
constexpr int kTuning = 150;

bool any_value(const WindowEstimate& e) {
  for (const double v : e.value)
    if (!std::isnan(v)) return true;
  return false;
}

double worst_frame_error(const Structure& s, const WindowEstimate& e,
                         const Eigen::VectorXd& theta) {
  const ParameterTable table(s);
  double worst = 0;
  for (int i = 0; i < table.size(); ++i) {
    if (table[i].kind != ParameterKind::frame_stiffness) continue;
    const double v = e.value[static_cast<std::size_t>(i)];
    worst = std::isnan(v) ? 1e9 : std::max(worst, std::abs(v / theta[i] - 1));
  }
  return worst;
}

TEST(Pipeline, GivesNoValueBeforeItsWarmUp) {
  const PipelineRun run = run_pipeline(small_config(), small_accel());
  // No window ends before the first sample: the triple fills first.
  ASSERT_EQ(run.estimates.size(), static_cast<std::size_t>(small_accel().rows() - kTriple));
  int first = -1;
  for (std::size_t i = 0; i < run.estimates.size(); ++i) {
    const WindowEstimate& e = run.estimates[i];
    EXPECT_EQ(e.sequence, static_cast<std::int64_t>(i));
    if (first < 0 && any_value(e)) first = static_cast<int>(i);
    if (static_cast<int>(i) < kWarmUp) {
      ASSERT_EQ(e.status, WindowStatus::warming_up) << i;
    }
  }
  EXPECT_GE(first, kWarmUp);
  EXPECT_LE(first, kWarmUp + kTuning);
  EXPECT_LT(worst_frame_error(small(), run.estimates.back(), small_theta()), 0.02);
}

TEST(Pipeline, WindowTimesMatchTheirSamples) {
  const PipelineRun run = run_pipeline(small_config(), small_accel());
  for (std::size_t i = 0; i < run.estimates.size(); ++i) {
    const WindowEstimate& e = run.estimates[i];
    // The triple looks 7 samples back.
    ASSERT_EQ(to_microseconds(e.end), 10000 * (static_cast<std::int64_t>(i) + kTriple - 7));
    // The window grows from a second to its full length.
    if (e.rows == 0) {
      ASSERT_LT(static_cast<int>(i), kWarmUp);
      continue;
    }
    ASSERT_EQ(e.rows, std::min(kWindow, static_cast<int>(i) + 2)) << i;
    ASSERT_EQ(to_microseconds(e.end) - to_microseconds(e.start), 10000 * (e.rows - 1));
  }
}

/// WHEN the design is far off, windows are held back until the filters are tuned and then come
/// late: every window of the motion is published once, on time or late.
TEST(Pipeline, WindowsHeldBackWhileTuningComeLate) {
  PipelineConfig config = small_config();
  config.design *= 0.3;
  std::vector<WindowEstimate> given, late;
  Pipeline pipeline(config);
  const auto take = [&](Pipeline::Results&& results) {
    for (const PipelineResult& r : results) {
      if (r.estimate != nullptr) given.push_back(*r.estimate);
      if (r.late != nullptr && r.late->window == 0) late.push_back(*r.late);
    }
  };
  for (int t = 0; t < small_accel().rows(); ++t)
    for (int a = 0; a < small_accel().cols(); ++a)
      take(pipeline.push(test::sample_at(small_accel(), 100, t, a)));
  take(pipeline.finish());
  const auto first = std::find_if(given.begin(), given.end(), any_value);
  ASSERT_NE(first, given.end());
  ASSERT_FALSE(late.empty());
  EXPECT_LE(late.front().end - given.front().end, std::chrono::milliseconds(10 * kWarmUp + 100));
  EXPECT_GE(late.back().end, first->end - std::chrono::milliseconds(100));
  for (std::size_t i = 0; i < late.size(); ++i) {
    EXPECT_TRUE(late[i].late);
    if (i > 0) {
      ASSERT_EQ(late[i].end - late[i - 1].end, std::chrono::milliseconds(10)) << i;
    }
    if (i > kWarmUp) {
      ASSERT_LT(worst_frame_error(small(), late[i], small_theta()), 0.05) << i;
    }
  }
}

TEST(Pipeline, TwoRunsAreByteIdentical) {
  const PipelineRun a = run_pipeline(small_config(), small_accel());
  const PipelineRun b = run_pipeline(small_config(), small_accel());
  ASSERT_EQ(a.estimates.size(), b.estimates.size());
  const auto same = [](const std::vector<double>& x, const std::vector<double>& y) {
    return std::memcmp(x.data(), y.data(), x.size() * sizeof(double)) == 0;
  };
  for (std::size_t i = 0; i < a.estimates.size(); ++i) {
    ASSERT_TRUE(same(a.estimates[i].value, b.estimates[i].value));
    ASSERT_TRUE(same(a.estimates[i].std_error, b.estimates[i].std_error));
    ASSERT_TRUE(same(a.estimates[i].snr, b.estimates[i].snr));
    ASSERT_EQ(a.estimates[i].reason, b.estimates[i].reason);
  }
}

TEST(Pipeline, HopOfSeveralRowsGivesTheSameWindowsLessOften) {
  PipelineConfig config = small_config();
  for (SensorAxis& axis : config.axes) axis.noise_density = 1e-3;
  const PipelineRun every = run_pipeline(config, small_accel());
  config.options.hop_s = 0.07;
  const PipelineRun some = run_pipeline(config, small_accel());
  ASSERT_EQ(some.estimates.size(), every.estimates.size() / 7);
  for (std::size_t i = 0; i < some.estimates.size(); ++i) {
    const WindowEstimate& a = some.estimates[i];
    const WindowEstimate& b = every.estimates[7 * i + 5];
    ASSERT_EQ(a.end, b.end);
    ASSERT_EQ(a.reason, b.reason);
    for (std::size_t p = 0; p < a.value.size(); ++p)
      if (!std::isnan(a.value[p])) {
        ASSERT_NEAR(a.value[p] / b.value[p], 1, 1e-9);
      }
  }
}

TEST(Pipeline, ValuesReturnAtOnceAfterAnInterruptionAndAreAsGood) {
  const int interrupted_at = 1200;
  const PipelineRun run = run_pipeline(small_config(), small_accel(), [&](int t, int) {
    return t < interrupted_at || t >= interrupted_at + 300;
  });
  EXPECT_EQ(run.counters.interruptions, 1);
  int without = 0;
  double worst = 0;
  for (const WindowEstimate& e : run.estimates) {
    if (to_microseconds(e.end) < 10000 * (interrupted_at + 300 - 7)) continue;
    const double error = worst_frame_error(small(), e, small_theta());
    if (error < 1)
      worst = std::max(worst, error);
    else
      ++without;
  }
  // Older rows are still in the window, so only the filters must refill.
  EXPECT_LT(without, kTriple + kShapes + 5);
  EXPECT_LT(worst, 0.05);
}

TEST(Pipeline, AfterALongInterruptionAValueComesWithinASecondOrTwo) {
  const int interrupted_at = 800, gap = 1200;  // longer than the longest window
  const PipelineRun run = run_pipeline(small_config(), small_accel(), [&](int t, int) {
    return t < interrupted_at || t >= interrupted_at + gap;
  });
  EXPECT_EQ(run.counters.interruptions, 1);
  int without = 0;
  for (const WindowEstimate& e : run.estimates)
    if (to_microseconds(e.end) >= 10000 * (interrupted_at + gap - 7) && !any_value(e)) ++without;
  EXPECT_GE(without, kWarmUp);
  EXPECT_LE(without, kWarmUp + kTriple + kShapes + 10);
}

TEST(Pipeline, ALostChannelCostsOnlyItsElementsUntilItReturns) {
  const int lost = 5;  // story 2, frame y2
  const int from = 1200, to = 1450;
  const PipelineRun run = run_pipeline(small_config(), small_accel(), [&](int t, int axis) {
    return axis != lost || t < from || t >= to;
  });
  const ParameterTable table(small());
  const auto touches = [&](int p) {
    return table[p].story == 2 && (table[p].frame == 1 || table[p].panel >= 0);
  };
  EXPECT_EQ(run.counters.interruptions, 0);
  EXPECT_EQ(run.counters.axes[lost].missing, to - from);
  for (const WindowEstimate& e : run.estimates) {
    const auto instant = to_microseconds(e.end) / 10000 + 7;
    for (int p = 0; p < table.size(); ++p) {
      const Observability reason = e.reason[static_cast<std::size_t>(p)];
      if (instant >= from && instant < to && touches(p)) {
        ASSERT_EQ(reason, Observability::channel_lost) << table[p].name << " " << instant;
      }
      if (!touches(p)) {
        ASSERT_NE(reason, Observability::channel_lost) << table[p].name;
      }
    }
  }
  // Another frame of the building continues all the time; the lost one's values return.
  const auto far = static_cast<std::size_t>(*table.find("kx_1_y1"));
  const auto near = static_cast<std::size_t>(*table.find("kx_2_y2"));
  for (const WindowEstimate& e : run.estimates)
    if (to_microseconds(e.end) / 10000 > 1000) {
      EXPECT_TRUE(e.reason[far] == Observability::observable ||
                  e.reason[far] == Observability::warming_up ||
                  e.reason[far] == Observability::quiet);
    }
  EXPECT_EQ(run.estimates.back().reason[near], Observability::observable);
  EXPECT_LT(worst_frame_error(small(), run.estimates.back(), small_theta()), 0.02);
}

TEST(Pipeline, DesignFourTimesWrongConverges) {
  for (const double factor : {0.25, 4.0}) {
    PipelineConfig config = small_config();
    config.design *= factor;
    const PipelineRun run = run_pipeline(config, small_accel());
    EXPECT_GT(run.counters.retunes, 0);
    EXPECT_LT(worst_frame_error(small(), run.estimates.back(), small_theta()), 0.01) << factor;
  }
}

void expect_converges(const Structure& s, const Eigen::VectorXd& theta, double rate_hz) {
  PipelineConfig config = test::pipeline_config(s, rate_hz);
  config.options.hop_s = 0.25;
  const PipelineRun run = run_pipeline(config, test::shaken(s, theta, rate_hz, 25));
  EXPECT_LT(worst_frame_error(s, run.estimates.back(), theta), 0.01);
}

TEST(Pipeline, NoDesignAtAllConvergesOnTheFirstBuilding) {
  expect_converges(test::table1(), test::table1_theta(), 100);
}

TEST(Pipeline, NoDesignAtAllConvergesOnTheSecondBuilding) {
  expect_converges(test::table2(), test::table2_theta('c'), 100);
}

TEST(Pipeline, OtherRatesWork) {
  for (const double rate_hz : {120.0, 200.0}) expect_converges(small(), small_theta(), rate_hz);
}

}  // namespace pipeline_test
}  // namespace framewatch::estimator
