// SPDX-License-Identifier: MIT
// Tests windows of other lengths than the main one, held values, named reasons, and the effect of a
// failing sensor.
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include <gtest/gtest.h>

#include "daemon/tools/lab/accuracy_trial.h"
#include "daemon/tools/lab/study_buildings.h"
#include "estimator/numeric/quantile.h"
#include "estimator/simulate/ground_motion.h"
#include "tests/support/pipeline_run.h"

namespace framewatch::estimator {
namespace other_windows_test {

constexpr double kNoise = 0.01;
constexpr double kDuration_s = 25;
/// A fifth of each window's length, in blocks of 0.25 s; [0] belongs to the main window.
constexpr std::int64_t kEvery_us[] = {10'000, 250'000, 500'000, 2'000'000};
constexpr int kFewest = 5;
/// Issue 3: parameters far from a lost sensor, compared with the full array.
constexpr double kFarErrorRatio = 2;
constexpr double kAlikePerMass = 400;     // 1/s^2: a first mode near 2 Hz
constexpr double kAlikeDamping_s = 2e-3;  // damping over stiffness
/// Two samples of the base, 20 ms apart, off by so much.
constexpr double kGlitched_s = 100, kGlitch_s = 70, kGlitch_mps2 = 10;
/// A value is wrong if it is off by more than this share of the truth and by more than so many of
/// its standard errors.
constexpr double kWrong = 0.03, kCertain = 5;
constexpr double kMostWrong = 0.001;  // share of the values that may be so
/// Instants until a filter is refilled, at most, and of the rows that a value needs.
constexpr int kFill = 30, kSecond = 100;

struct Shaken {
  Shaken(const Structure& s, const Eigen::VectorXd& theta, double duration_s)
      : structure(s), table(s), truth(theta) {
    KanaiTajimi motion;
    motion.seed = 7;
    motion.duration_s = duration_s;
    const daemon::ExactRecord record = daemon::exact_record(
        s, theta, directed(kanai_tajimi(motion), M_PI / 4), kNoise, duration_s);
    accel = daemon::with_noise(record, 5);
    config = {s, record.axes, {}, daemon::perturbed_design(table, theta, 0.1, 0.3, 11)};
  }
  double median_error(const WindowEstimate& e, ParameterKind kind,
                      const std::function<bool(int)>& chosen = {}) const {
    std::vector<double> errors;
    for (int p = 0; p < table.size(); ++p)
      if (table[p].kind == kind && (!chosen || chosen(p)))
        errors.push_back(std::abs(e.solution[static_cast<std::size_t>(p)] / truth[p] - 1));
    return upper_median(errors);
  }
  Structure structure;
  ParameterTable table;
  Eigen::VectorXd truth;
  PipelineConfig config;
  Eigen::MatrixXd accel;
};

TEST(OtherWindows, FourASecondEachFromTheSameBlocks) {
  const Shaken b(daemon::table1(), daemon::table1_theta(), kDuration_s);
  std::map<int, std::vector<WindowEstimate>> given;
  const auto keep = [&](const WindowEstimate& e) { given[e.window].push_back(e); };
  Pipeline pipeline(b.config);
  for (int t = 0; t < b.accel.rows(); ++t)
    for (int a = 0; a < b.accel.cols(); ++a)
      each_window(pipeline.push(test::sample_at(b.accel, 100, t, a)), keep);
  each_window(pipeline.finish(), keep);

  const std::vector<int> rows = pipeline.other_window_rows();
  ASSERT_EQ(rows, (std::vector<int>{100, 250, 1000}));
  std::map<int, double> spread;
  for (int w = 1; w <= 3; ++w) {
    ASSERT_FALSE(given[w].empty()) << w;
    double error = 0;
    int valid = 0;
    for (std::size_t i = 0; i < given[w].size(); ++i) {
      const WindowEstimate& e = given[w][i];
      EXPECT_EQ(e.sequence, static_cast<std::int64_t>(i));
      EXPECT_EQ(e.rows, rows[static_cast<std::size_t>(w - 1)]);
      EXPECT_EQ(to_microseconds(e.end) - to_microseconds(e.start), (e.rows - 1) * 10000);
      if (i > 0) {
        EXPECT_EQ((to_microseconds(e.end) - to_microseconds(given[w][i - 1].end)) % kEvery_us[w],
                  0);
      }
      if (e.status != WindowStatus::valid) continue;
      ++valid;
      error += b.median_error(e, ParameterKind::frame_stiffness);
    }
    ASSERT_GT(valid, kFewest) << w;
    spread[w] = error / valid;
  }
  EXPECT_GT(spread[1], spread[2]);
  EXPECT_GT(spread[2], spread[3]);
  EXPECT_LT(spread[3], 0.001);
}

/// Two samples of a loose connector pass for ringing. Windows of every length, which hold them for
/// so long, must withhold their values or state errors that cover them.
TEST(OtherWindows, CountAGlitchAnywhereInTheWindow) {
  Shaken b(daemon::table1(), daemon::table1_theta(), kGlitched_s);
  int base = 0;
  while (b.config.axes[static_cast<std::size_t>(base)].story != 0) ++base;
  const int glitch = static_cast<int>(kGlitch_s * 100);
  b.accel(glitch, base) += kGlitch_mps2;
  b.accel(glitch + 2, base) += kGlitch_mps2;
  Pipeline pipeline(b.config);
  std::map<int, int> values, after, withheld, wrong;
  const auto judge = [&](const WindowEstimate& e) {
    if (e.status == WindowStatus::warming_up) return;
    const bool late = seconds_of(e.end - Time{}) > kGlitch_s;
    for (int p = 0; p < b.table.size(); ++p) {
      if (b.table[p].kind != ParameterKind::frame_stiffness) continue;
      const auto u = static_cast<std::size_t>(p);
      const bool known = e.reason[u] == Observability::observable;
      after[e.window] += late ? 1 : 0;
      withheld[e.window] += late && !known ? 1 : 0;
      if (!known) continue;
      ++values[e.window];
      const double error = std::abs(e.value[u] - b.truth[p]);
      wrong[e.window] += error > kWrong * b.truth[p] && error > kCertain * e.std_error[u] ? 1 : 0;
    }
  };
  for (int t = 0; t < b.accel.rows(); ++t)
    for (int a = 0; a < b.accel.cols(); ++a)
      each_window(pipeline.push(test::sample_at(b.accel, 100, t, a)), judge);
  for (int w = 0; w <= 3; ++w) {
    EXPECT_LE(wrong[w], kMostWrong * values[w]) << "window " << w;
    EXPECT_LT(2 * withheld[w], after[w]) << "window " << w;
  }
}

TEST(HeldValues, ADyingChannelLeavesOthersAlone) {
  const Shaken b(daemon::table1(), daemon::table1_theta(), 50);
  const int lost = [&] {
    for (std::size_t a = 0; a < b.config.axes.size(); ++a)
      if (b.config.axes[a].story == 5 && b.config.axes[a].frame == 0) return static_cast<int>(a);
    return -1;
  }();
  const int from = 2000, to = 4000;
  const test::PipelineRun whole = test::run_pipeline(b.config, b.accel);
  const test::PipelineRun run = test::run_pipeline(
      b.config, b.accel, [&](int t, int axis) { return axis != lost || t < from || t >= to; });
  const auto touches = [&](int p) {
    return b.table[p].story == 5 && (b.table[p].frame == 0 || b.table[p].panel >= 0);
  };
  const auto far = [&](int p) { return b.table[p].story <= 3; };
  ASSERT_EQ(run.estimates.size(), whole.estimates.size());
  double with = 0, without = 0;
  int back_at = -1;
  for (std::size_t i = 0; i < run.estimates.size(); ++i) {
    const WindowEstimate& e = run.estimates[i];
    const auto instant = to_microseconds(e.end) / 10000 + 7;
    if (instant < 1500) continue;
    for (int p = 0; p < b.table.size(); ++p) {
      const auto u = static_cast<std::size_t>(p);
      if (touches(p) && instant >= from + 50 && instant < to) {
        ASSERT_EQ(e.reason[u], Observability::channel_lost) << b.table[p].name << " " << instant;
        ASSERT_LT(to_microseconds(e.last_end[u]) / 10000, from + kFill) << b.table[p].name;
        ASSERT_FALSE(std::isnan(e.last_value[u]));
      }
      if (far(p) && b.table[p].kind == ParameterKind::frame_stiffness) {
        ASSERT_EQ(e.reason[u], Observability::observable) << b.table[p].name << " " << instant;
      }
    }
    if (instant >= from && instant < to) {
      with += b.median_error(e, ParameterKind::frame_stiffness, far);
      without += b.median_error(whole.estimates[i], ParameterKind::frame_stiffness, far);
    }
    const auto near = static_cast<std::size_t>(*b.table.find("kx_5_y1"));
    if (instant > to && back_at < 0 && e.reason[near] == Observability::observable)
      back_at = static_cast<int>(instant);
  }
  EXPECT_LT(with, kFarErrorRatio * without);
  EXPECT_GT(back_at, to + kFill);
  EXPECT_LT(back_at, to + kFill + kSecond);
}

TEST(Reasons, DistinguishAStiffFloorFromASymmetricPlan) {
  // GIVEN a building with floors a hundred times too stiff to be seen, and one whose frames are all
  // alike
  const Structure s = daemon::table2();
  Eigen::VectorXd stiff = daemon::table2_theta('d');
  const ParameterTable table(s);
  for (int p = 0; p < table.size(); ++p)
    if (table[p].panel >= 0) stiff[p] *= 100;
  Structure plain = s;
  std::fill(plain.node_mass.begin(), plain.node_mass.end(), plain.node_mass.front());
  Eigen::VectorXd alike = daemon::table2_theta('c');
  for (int p = 0; p < table.size(); ++p) {
    if (table[p].frame < 0) continue;
    const bool stiffness = table[p].kind == ParameterKind::frame_stiffness;
    const double per_mass = stiffness ? kAlikePerMass : kAlikeDamping_s * kAlikePerMass;
    alike[p] = per_mass * plain.frame_mass(table[p].story, table[p].frame);
  }
  const auto panel = static_cast<std::size_t>(*table.find("Gk_1_x1y1"));
  const auto frame = static_cast<std::size_t>(*table.find("kx_1_y1"));
  const Shaken a(s, stiff, kDuration_s);
  const WindowEstimate of_stiff = test::run_pipeline(a.config, a.accel).estimates.back();
  EXPECT_EQ(of_stiff.reason[frame], Observability::observable);
  EXPECT_EQ(of_stiff.reason[panel], Observability::floor_too_stiff);
  const Shaken c(plain, alike, kDuration_s);
  const WindowEstimate of_alike = test::run_pipeline(c.config, c.accel).estimates.back();
  EXPECT_EQ(of_alike.reason[frame], Observability::observable);
  EXPECT_EQ(of_alike.reason[panel], Observability::symmetric_plan);
}

TEST(MeasuredNoise, IsUsedIfNoneIsConfigured) {
  Shaken b(daemon::table2(), daemon::table2_theta('c'), kDuration_s);
  std::vector<double> truth;
  for (SensorAxis& axis : b.config.axes) {
    truth.push_back(axis.noise_density);
    axis.noise_density = 0;
  }
  Pipeline pipeline(b.config);
  for (int t = 0; t < b.accel.rows(); ++t)
    for (int a = 0; a < b.accel.cols(); ++a) pipeline.push(test::sample_at(b.accel, 100, t, a));
  pipeline.finish();
  const std::vector<double> density = pipeline.noise_density();
  ASSERT_EQ(density.size(), truth.size());
  for (std::size_t a = 0; a < truth.size(); ++a)
    EXPECT_GT(density[a], 0.6 * truth[a]) << b.config.axes[a].name;
}

}  // namespace other_windows_test
}  // namespace framewatch::estimator
