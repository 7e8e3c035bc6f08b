// SPDX-License-Identifier: MIT
// Coverage of the stated 95 % intervals of peak drifts. FRAMEWATCH_DRIFT_RUNS=24 runs more
// earthquakes of every layout and prints the table of docs/equations.md.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include <gtest/gtest.h>

#include "daemon/tools/lab/study_buildings.h"
#include "estimator/pipeline/pipeline.h"
#include "estimator/shaking/shaking_watch.h"
#include "estimator/shaking/story_drift.h"
#include "estimator/simulate/ground_motion.h"
#include "estimator/simulate/linear_building.h"
#include "estimator/simulate/linear_response.h"
#include "estimator/simulate/random.h"
#include "estimator/simulate/sensor_model.h"
#include "estimator/structure/natural_frequencies.h"
#include "tests/support/paper_buildings.h"

namespace framewatch::estimator {
namespace drift_coverage_test {

constexpr double kRate_hz = 100, kNormal95 = 1.96;
constexpr double kFirst_s = 60, kSecond_s = 60;  // the stiffness is learned in the first
constexpr double kMinCoverage = 0.90, kMaxCoverage = 0.99;

/// Keeps the largest drifts of a building, at every fine step of its integration.
class WatchedBuilding : public SimulatedBuilding {
 public:
  WatchedBuilding(std::unique_ptr<SimulatedBuilding> building, const Structure& structure,
                  Eigen::VectorXd& largest, double from_s)
      : building_(std::move(building)), structure_(structure), largest_(largest), from_s_(from_s) {
    largest_.setZero(structure.degrees_of_freedom());
  }
  void set_theta(const Eigen::VectorXd& theta) override { building_->set_theta(theta); }
  void advance(const Eigen::Vector2d& before, const Eigen::Vector2d& after) override {
    building_->advance(before, after);
    time_s_ += building_->step_s();
    if (time_s_ < from_s_) return;
    Eigen::VectorXd drift = building_->disp_rel();
    for (Eigen::Index dof = drift.size(); dof-- > structure_.frames();)
      drift[dof] -= drift[dof - structure_.frames()];
    largest_ = largest_.cwiseMax(drift.cwiseAbs());
  }
  double step_s() const override { return building_->step_s(); }
  void set_time(double time_s) override { building_->set_time(time_s); }
  Eigen::VectorXd disp_rel() const override { return building_->disp_rel(); }
  Eigen::VectorXd vel_rel() const override { return building_->vel_rel(); }
  const Eigen::VectorXd& accel_abs() const override { return building_->accel_abs(); }
  std::vector<double> motion() const override { return building_->motion(); }
  bool resume(const std::vector<double>& motion) override { return building_->resume(motion); }

 private:
  std::unique_ptr<SimulatedBuilding> building_;
  const Structure& structure_;
  Eigen::VectorXd& largest_;
  double from_s_, time_s_ = 0;
};

struct Layout {
  const char* name;
  PipelineConfig config;  ///< the estimator's; the true building differs
  double noise_density;   ///< m/s^2/sqrt(Hz)
};

/// Returns a plane building of so many stories with a given lowest frequency.
Layout plane(const char* name, int stories, double lowest_hz, const std::vector<int>& floors,
             double noise_density) {
  PipelineConfig c;
  c.structure = daemon::tall_building(stories);
  c.design = daemon::tall_design(stories);
  const ParameterTable table(c.structure);
  c.design *= std::pow(lowest_hz / lowest_frequency_hz(c.structure, table, c.design), 2);
  c.design = with_proportional_damping(c.structure, table, c.design, 0.03);
  c.axes = daemon::floor_axes(floors);
  c.options.rate_hz = kRate_hz;
  return {name, c, noise_density};
}

std::vector<int> every_floor(int stories) {
  std::vector<int> out;
  for (int floor = 1; floor <= stories; ++floor) out.push_back(floor);
  return out;
}

Layout in_space(const char* name, double noise_density) {
  PipelineConfig c;
  c.structure = test::table1();
  c.design = test::table1_theta();
  c.axes = test::full_sensor_axes(c.structure);
  c.options.rate_hz = kRate_hz;
  return {name, c, noise_density};
}

std::vector<Layout> layouts() {
  return {plane("6 stories, 1 Hz, every floor", 6, 1, every_floor(6), 1e-4),
          plane("6 stories, 3 Hz, every floor", 6, 3, every_floor(6), 1e-4),
          plane("10 stories, 0.5 Hz, every floor", 10, 0.5, every_floor(10), 1e-4),
          in_space("5 stories in space, every floor", 1e-4),
          plane("6 stories, 1 Hz, floors 2, 4, 6", 6, 1, {2, 4, 6}, 1e-4),
          plane("6 stories, 1 Hz, roof", 6, 1, {6}, 1e-4),
          plane("12 stories, 0.8 Hz, floors 4, 8, 12", 12, 0.8, {4, 8, 12}, 1e-4),
          plane("12 stories, 0.8 Hz, floors 4, 8", 12, 0.8, {4, 8}, 1e-4),
          plane("10 stories, 0.5 Hz, floors 5, 10, noisy", 10, 0.5, {5, 10}, 1e-3)};
}

GroundMotion quake(std::uint64_t seed, double peak_mps2) {
  KanaiTajimi ground;
  ground.peak_mps2 = peak_mps2;
  ground.duration_s = 30;
  ground.strong_s = 8;
  ground.decay_s = 5;
  ground.step_s = 1e-3;
  ground.seed = seed;
  return kanai_tajimi(ground);
}

/// Two earthquakes, the second twice as strong, each with quiet behind it.
PlanMotion two_quakes(std::uint64_t seed) {
  GroundMotion out{1e-3,
                   std::vector<double>(static_cast<std::size_t>(1e3 * (kFirst_s + kSecond_s)))};
  const auto put = [&](const GroundMotion& motion, double from_s) {
    const auto from = static_cast<std::size_t>(from_s / out.step_s);
    for (std::size_t i = 0; i < motion.accel.size(); ++i) out.accel[from + i] = motion.accel[i];
  };
  put(quake(2 * seed, 1), 10);
  put(quake(2 * seed + 1, 2), kFirst_s + 5);
  return directed(out, 0.5);
}

struct Tally {
  int stories = 0, held = 0, gaps = 0, unknown = 0;
  double squares = 0, relative_error = 0;
  double bias = 0;
};

void run(const Layout& layout, std::uint64_t seed, Tally& tally) {
  Random random(seed, 7);
  const PipelineConfig& told = layout.config;
  Structure truly = told.structure;
  const ParameterTable stories(truly);
  Eigen::VectorXd theta = told.design;
  for (int p = 0; p < stories.elements(); ++p) {
    const double factor = std::exp(told.profile_tolerance * random.normal());
    theta[p] *= factor;
    theta[p + stories.elements()] *= factor;
  }
  for (double& mass : truly.node_mass) mass *= std::exp(told.mass_tolerance * random.normal());

  PipelineConfig config = told;
  for (SensorAxis& axis : config.axes) axis.noise_density = layout.noise_density;
  if (!config.parameters().grouped()) config.design.resize(0);
  ResponseOptions options;
  options.rate_hz = kRate_hz;
  Eigen::VectorXd truth;
  auto building = std::make_unique<LinearBuilding>(truly, stories, theta, fine_step_s(options));
  ResponseStream response(
      std::make_unique<WatchedBuilding>(std::move(building), truly, truth, kFirst_s),
      two_quakes(seed), options, {}, response_channels(truly, config.axes));
  SensorArray sensors(
      config.axes,
      std::vector<SensorModel>(config.axes.size(), {.noise_density = layout.noise_density}),
      kRate_hz, seed);

  std::vector<StoryDrift> drifts;
  ShakingWatch watch(config, {});
  Pipeline pipeline(config);
  const auto take = [&](Pipeline::Results&& results) {
    for (const PipelineResult& r : results) {
      if (r.instant != nullptr && watch.push(*r.instant, nullptr))
        drifts = story_drifts(config, watch.ended().peak, watch.ended().known);
      if (r.estimate != nullptr) watch.push(*r.estimate);
    }
  };
  const int instants = static_cast<int>((kFirst_s + kSecond_s) * kRate_hz);
  for (int i = 0; i < instants; ++i) {
    const std::vector<double>& raw = sensors.measure(i / kRate_hz, response.next());
    for (std::size_t a = 0; a < raw.size(); ++a)
      take(pipeline.push(
          {from_microseconds(std::llround(1e6 * i / kRate_hz)), static_cast<int>(a), raw[a]}));
  }
  take(pipeline.finish());
  ASSERT_EQ(drifts.size(), static_cast<std::size_t>(truly.stories)) << layout.name;
  for (const StoryDrift& d : drifts) {
    if (d.interrupted_at_peak()) {
      ++tally.gaps;
      continue;
    }
    if (!d.known() || !std::isfinite(d.std_error)) {
      ++tally.unknown;
      continue;
    }
    double largest = 0;
    for (int f = 0; f < truly.frames(); ++f)
      largest = std::max(largest, truth[truly.dof(d.story, f)]);
    const double off =
        d.ratio / (largest / truly.story_height[static_cast<std::size_t>(d.story - 1)]) - 1;
    const double error = d.std_error / d.ratio;
    ++tally.stories;
    if (std::abs(off) <= kNormal95 * error) ++tally.held;
    tally.squares += off * off;
    tally.bias += off;
    tally.relative_error += error;
  }
}

TEST(DriftCoverage, StatedIntervalsHoldTheTruth) {
  const char* wanted = std::getenv("FRAMEWATCH_DRIFT_RUNS");
  const int runs = wanted != nullptr ? std::atoi(wanted) : 2;
  Tally all;
  std::printf("| layout | drifts | inside | rms error | stated | bias | not judged |\n");
  for (const Layout& layout : layouts()) {
    Tally tally;
    for (int seed = 1; seed <= runs; ++seed) run(layout, static_cast<std::uint64_t>(seed), tally);
    const double n = std::max(1, tally.stories);
    std::printf("| %s | %d | %.1f %% | %.2f %% | %.2f %% | %+.2f %% | %d |\n", layout.name,
                tally.stories, 100 * tally.held / n, 100 * std::sqrt(tally.squares / n),
                100 * tally.relative_error / n, 100 * tally.bias / n, tally.gaps + tally.unknown);
    all.stories += tally.stories;
    all.held += tally.held;
    all.gaps += tally.gaps + tally.unknown;
  }
  const double held = static_cast<double>(all.held) / all.stories;
  std::printf("| all | %d | %.1f %% | | | | %d |\n", all.stories, 100 * held, all.gaps);
  EXPECT_GE(held, kMinCoverage);
  EXPECT_LE(held, kMaxCoverage);
}

}  // namespace drift_coverage_test
}  // namespace framewatch::estimator
