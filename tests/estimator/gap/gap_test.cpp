// SPDX-License-Identifier: MIT
// Simulation beside measurement: with the right model only noise remains, a wrong model raises an
// event, and failing sensors do neither.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "estimator/gap/gap_monitor.h"
#include "estimator/numeric/nan.h"
#include "estimator/simulate/linear_response.h"
#include "estimator/simulate/random.h"
#include "estimator/state/archive.h"
#include "estimator/structure/natural_frequencies.h"

namespace framewatch::estimator {
namespace gap_test {

constexpr double kRate_hz = 100,
                 kNoise = 5e-3;  // m/s^2/sqrt(Hz): the floor exceeds every other error
constexpr double kSeconds = 90;
constexpr double kFloorOff = 0.15;  // relative: 10-s windows of narrow-band noise
constexpr double kSchemeError = 1e-3, kLawError = 5e-3;

/// Two stories of one frame, 2.6 and 6.9 Hz, 2 % damping.
class Gap : public testing::Test {
 protected:
  Gap() : structure_(plane()), table_(structure_) {
    theta_ = Eigen::VectorXd::Zero(table_.size());
    theta_[table_.frame_stiffness(1, 0)] = 28e3;
    theta_[table_.frame_stiffness(2, 0)] = 26e3;
    theta_ = with_proportional_damping(structure_, table_, theta_, 0.02);
    for (int story = 0; story <= 2; ++story) {
      SensorAxis axis;
      axis.name = "F" + std::to_string(story);
      axis.story = story;
      axis.frame = story > 0 ? 0 : -1;
      axes_.push_back(axis);
    }
  }

  static Structure plane() {
    Structure s;
    s.name = "plane";
    s.stories = 2;
    s.frames_x = {"y1"};
    s.story_height = {3, 3};
    s.node_mass = {40, 40};
    return s;
  }

  /// Returns the axes' readings of a building with these effects. The first floor's axis is late.
  std::vector<SampleSet> measured(double noise, const std::vector<Effect>& effects = {},
                                  double late_s = 0) const {
    KanaiTajimi ground;
    ground.duration_s = kSeconds + 1, ground.strong_s = kSeconds, ground.ground_frequency_hz = 3;
    const GroundMotion motion = kanai_tajimi(ground);
    ResponseStream stream(structure_, table_, theta_, directed(motion, 0), {}, {},
                          {{0, late_s}, {1}, {2}, {3}}, effects);
    Random random(7);
    std::vector<SampleSet> out;
    for (int i = 0; i < kSeconds * kRate_hz; ++i) {
      const Eigen::VectorXd& a = stream.next();
      SampleSet set{from_microseconds(10'000LL * i), i, {a[2], a[0], a[1]}};
      for (double& value : set.accel) value += noise * std::sqrt(kRate_hz / 2) * random.normal();
      out.push_back(set);
    }
    return out;
  }

  GapMonitor monitor(const GapModel& model) const {
    PipelineConfig config;
    config.structure = structure_;
    config.axes = axes_;
    return GapMonitor(config, axes_, options_, model);
  }

  /// Collects every gap and every event of a monitor.
  struct Seen {
    std::vector<GapWindow> windows;
    std::vector<GapNews> news;
  };
  static void run(GapMonitor& monitor, const std::vector<SampleSet>& sets, double noise, Seen& seen,
                  std::size_t from = 0, std::size_t to = SIZE_MAX) {
    const std::vector<double> density(sets.front().accel.size(), noise);
    for (std::size_t i = from; i < std::min(to, sets.size()); ++i) {
      if (const GapWindow* w = monitor.push(sets[i], density)) seen.windows.push_back(*w);
      if (monitor.news() != nullptr) seen.news.push_back(*monitor.news());
    }
  }

  Structure structure_;
  ParameterTable table_;
  Eigen::VectorXd theta_;
  std::vector<SensorAxis> axes_;
  GapOptions options_;
};

TEST_F(Gap, IsAtTheNoiseFloorForTheRightModel) {
  GapMonitor m = monitor({theta_, {}});
  Seen seen;
  run(m, measured(kNoise), kNoise, seen);
  ASSERT_GT(seen.windows.size(), 50u);
  double gap = 0, floor = 0;
  for (const GapWindow& w : seen.windows) {
    gap += w.nrmse * w.nrmse;
    floor += w.floor * w.floor;
    EXPECT_TRUE(std::isnan(w.axis_nrmse[0]));
    EXPECT_EQ(w.end - w.start, std::chrono::seconds(10));
  }
  EXPECT_NEAR(std::sqrt(gap / floor), 1, kFloorOff);
  EXPECT_TRUE(seen.news.empty());
}

TEST_F(Gap, IsTheIntegrationErrorWithoutNoise) {
  GapMonitor m = monitor({theta_, {}});
  Seen seen;
  run(m, measured(0), 0, seen);
  for (const GapWindow& w : seen.windows) EXPECT_LT(w.nrmse, kSchemeError);
}

TEST_F(Gap, IgnoresVerticalAndForceChannels) {
  axes_.resize(5);
  axes_[3].name = "up";
  axes_[3].vertical = true;
  axes_[4].name = "shaker";
  axes_[4].story = 2;
  axes_[4].is_force = true;
  GapMonitor m = monitor({theta_, {}});
  std::vector<SampleSet> sets = measured(0);
  for (SampleSet& set : sets) set.accel.insert(set.accel.end(), {3 * set.accel[1], 1e3});
  Seen seen;
  run(m, sets, 0, seen);
  ASSERT_FALSE(seen.windows.empty());
  EXPECT_LT(seen.windows.back().nrmse, kSchemeError);
  EXPECT_TRUE(std::isnan(seen.windows.back().axis_nrmse[4]));
}

TEST_F(Gap, IncludesLawsAndChannelErrors) {
  constexpr double kLate_s = 0.013;
  Effect cubic = make_effect(EffectKind::cubic_stiffness, {PlaceKind::frame, 1, 0});
  cubic.set("k3_npm3", 5e7);
  Effect hysteresis = make_effect(EffectKind::bilinear_hysteresis, {PlaceKind::frame, 2, 0});
  hysteresis.set("kh_npm", 5e3);
  hysteresis.set("dy_m", 2e-3);
  Effect gain = make_effect(EffectKind::gain_error, {});
  gain.place = {.kind = PlaceKind::channel, .channel = 2};
  gain.set("gain", 0.1);
  Effect shift = make_effect(EffectKind::time_shift, {});
  shift.place = {.kind = PlaceKind::channel, .channel = 1};
  shift.set("shift_s", kLate_s);
  std::vector<SampleSet> sets = measured(0, {cubic, hysteresis}, kLate_s);
  for (SampleSet& set : sets) set.accel[2] *= 1.1;
  GapMonitor right = monitor({theta_, {cubic, hysteresis, gain, shift}});
  GapMonitor wrong = monitor({theta_, {}});
  Seen with, without;
  run(right, sets, 1e-6, with);
  run(wrong, sets, 1e-6, without);
  ASSERT_FALSE(with.windows.empty());
  EXPECT_LT(with.windows.back().nrmse, kLawError);
  EXPECT_GT(without.windows.back().nrmse, 0.2);
}

TEST_F(Gap, RaisesOneEventIfItLastsUntilTheModelIsRight) {
  Eigen::VectorXd off = theta_;
  off[0] *= 0.9;
  GapMonitor m = monitor({off, {}});
  const std::vector<SampleSet> sets = measured(kNoise / 10);
  Seen seen;
  run(m, sets, kNoise / 10, seen, 0, sets.size() / 2);
  ASSERT_EQ(seen.news.size(), 1u);
  const GapNews raised = seen.news.front();
  EXPECT_EQ(raised.state, AlarmState::raised);
  EXPECT_GT(raised.excess, options_.raise_ratio);
  EXPECT_GT(raised.worst_axis, 0);
  EXPECT_GE(raised.found - raised.since, std::chrono::seconds(10));
  m.adopt({theta_, {}});
  run(m, sets, kNoise / 10, seen, sets.size() / 2);
  ASSERT_EQ(seen.news.size(), 2u);
  EXPECT_EQ(seen.news.back().state, AlarmState::cleared);
  EXPECT_EQ(seen.news.back().id, raised.id);
}

TEST_F(Gap, IsNotComputedIfNoiseIsAsLarge) {
  Eigen::VectorXd off = theta_;
  off[0] *= 0.9;
  GapMonitor m = monitor({off, {}});
  std::vector<SampleSet> sets = measured(kNoise);
  for (SampleSet& set : sets)
    for (double& value : set.accel) value *= 1e-3;
  Seen seen;
  run(m, sets, kNoise, seen);
  EXPECT_FALSE(seen.windows.empty());
  EXPECT_TRUE(seen.news.empty());
}

TEST_F(Gap, LeavesOutALostChannel) {
  std::vector<SampleSet> sets = measured(kNoise);
  for (std::size_t i = 4000; i < 7000; ++i) sets[i].accel[1] = kNaN;
  GapMonitor m = monitor({theta_, {}});
  Seen seen;
  run(m, sets, kNoise, seen);
  const auto at = [&](double end_s) {
    const auto found = std::find_if(seen.windows.begin(), seen.windows.end(), [&](const auto& w) {
      return w.end >= from_microseconds(static_cast<std::int64_t>(1e6 * end_s));
    });
    return found == seen.windows.end() ? GapWindow{} : *found;
  };
  EXPECT_TRUE(std::isnan(at(55).axis_nrmse[1]));
  EXPECT_LT(at(55).axis_nrmse[2], 2 * at(55).axis_floor[2]);
  EXPECT_TRUE(std::isfinite(at(82).axis_nrmse[1]));
}

TEST_F(Gap, RestartsAfterALossOfTheBaseHasDecayed) {
  std::vector<SampleSet> sets = measured(kNoise / 10);
  for (std::size_t i = 4000; i < 4100; ++i) sets[i].accel[0] = kNaN;
  GapMonitor m = monitor({theta_, {}});
  Seen seen;
  run(m, sets, kNoise / 10, seen);
  ASSERT_FALSE(seen.windows.empty());
  EXPECT_GT(seen.windows.back().end, from_microseconds(80'000'000));
  bool any = false;
  for (const GapWindow& w : seen.windows) {
    const double end_s = 1e-6 * static_cast<double>(to_microseconds(w.end));
    EXPECT_FALSE(end_s > 40 && end_s < 60) << end_s;
    any = any || end_s < 40;
    EXPECT_LT(w.nrmse, 0.02);
  }
  EXPECT_TRUE(any);
}

TEST_F(Gap, ContinuesBitByBitFromItsState) {
  Effect hysteresis = make_effect(EffectKind::bilinear_hysteresis, {PlaceKind::frame, 2, 0});
  hysteresis.set("kh_npm", 5e3);
  hysteresis.set("dy_m", 2e-3);
  const GapModel model{theta_, {hysteresis}};
  const std::vector<SampleSet> sets = measured(kNoise, {hysteresis});
  for (const std::size_t cut : {500u, 2345u, 6001u}) {
    GapMonitor whole = monitor(model), before = monitor(model), after = monitor(model);
    Seen uncut, first, second;
    run(whole, sets, kNoise, uncut);
    run(before, sets, kNoise, first, 0, cut);
    run(after, sets, kNoise, second, 0, 777);  // reveals a member that archive() forgot
    second = {};
    StateWriter writer;
    writer(before);
    const std::vector<std::uint8_t> bytes = writer.bytes();
    StateReader reader(bytes);
    reader(after);
    ASSERT_TRUE(reader.whole());
    run(after, sets, kNoise, second, cut);
    ASSERT_EQ(first.windows.size() + second.windows.size(), uncut.windows.size());
    for (std::size_t i = 0; i < second.windows.size(); ++i) {
      const GapWindow& w = uncut.windows[first.windows.size() + i];
      EXPECT_EQ(second.windows[i].nrmse, w.nrmse) << i;
      EXPECT_TRUE(second.windows[i].floor == w.floor || std::isnan(w.floor)) << i;
    }
  }
}

TEST_F(Gap, LearnsAModelByDefault) {
  PipelineConfig config;
  config.structure = structure_;
  config.axes = axes_;
  GapMonitor m(config, axes_, options_, std::nullopt);
  WindowEstimate window(table_.size());
  window.status = WindowStatus::valid;
  std::fill(window.prior_share.begin(), window.prior_share.end(), 0.0);
  std::fill(window.noise_share.begin(), window.noise_share.end(), 0.0);
  Eigen::VectorXd believed = 1.5 * theta_;
  for (int i = 1; i <= 14; ++i) {  // the last two only confirm
    EXPECT_FALSE(m.has_model());
    window.start = from_microseconds(6'000'000LL * i);
    window.end = window.start + std::chrono::seconds(5);
    for (int p = 0; p < table_.size(); ++p) {
      const auto at = static_cast<std::size_t>(p);
      const bool seen = p < table_.elements();  // damping is never published here
      window.value[at] = seen ? theta_[p] : kNaN;
      window.std_error[at] = seen ? 0.01 * theta_[p] : kNaN;
      window.reason[at] = seen ? Observability::observable : Observability::quiet;
    }
    for (int p = table_.elements(); p < table_.size(); ++p) believed[p] = theta_[p];
    m.learn(window, believed);
    if (m.has_model()) break;
  }
  ASSERT_TRUE(m.has_model());
  Seen seen;
  run(m, measured(0), 0, seen);
  ASSERT_FALSE(seen.windows.empty());
  EXPECT_LT(seen.windows.back().nrmse, kSchemeError);
}

}  // namespace gap_test
}  // namespace framewatch::estimator
