// SPDX-License-Identifier: MIT
#include "tests/earthquake/study_buildings.h"

#include <cmath>

#include <fmt/core.h>

#include "estimator/simulate/random.h"
#include "estimator/structure/natural_frequencies.h"

namespace framewatch::earthquake {
namespace {

constexpr double kPlaneDamping = 0.03, kSpaceDamping = 0.01, kTallDamping = 0.015;
constexpr double kTopShare = 0.35;     // of the lowest story's stiffness
constexpr double kTallPeriod_s = 0.1;  // a story

/// One axis for each frame of each of these floors, and the base's.
std::vector<estimator::SensorAxis> axes_on(const estimator::Structure& s,
                                           const std::vector<int>& floors) {
  std::vector<estimator::SensorAxis> axes;
  const auto add = [&](int story, int frame, estimator::Direction direction) {
    axes.emplace_back();
    axes.back().name = fmt::format("F{}-{}{}", story, letter(direction), frame);
    axes.back().story = story, axes.back().frame = frame, axes.back().direction = direction;
  };
  for (const int floor : floors)
    for (int f = 0; f < s.frames(); ++f) add(floor, f, s.direction(f));
  if (s.n() > 0) add(0, -1, estimator::Direction::x);
  if (s.m() > 0) add(0, -1, estimator::Direction::y);
  return axes;
}

}  // namespace

StudyBuilding three_stories() {
  StudyBuilding out{"3 stories, all floors", {}};
  estimator::Structure& s = out.config.structure;
  s.name = "three stories";
  s.stories = 3;
  s.frames_x = {"y1"};
  s.story_height.assign(3, 3.5);
  s.node_mass.assign(3, 5e5);
  const estimator::ParameterTable table(s);
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(table.size());
  theta.head(3) << 9e8, 8e8, 6e8;
  out.config.design = with_proportional_damping(s, table, theta, kPlaneDamping);
  out.config.axes = axes_on(s, {1, 2, 3});
  return out;
}

StudyBuilding two_stories_in_space() {
  StudyBuilding out{"2 stories in space, flexible floors", {}};
  estimator::Structure& s = out.config.structure;
  s.name = "two stories in space";
  s.stories = 2;
  s.frames_x = {"y1", "y2"};
  s.frames_y = {"x1", "x2"};
  s.span_x = {1.0};
  s.span_y = {1.0};
  s.story_height.assign(2, 1.0);
  s.node_mass.assign(static_cast<std::size_t>(s.nodes()), 20.0);
  const estimator::ParameterTable table(s);
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(table.size());
  theta.head(table.elements()) << 38e3, 22e3, 32e3, 19e3, 23e3, 36e3, 21e3, 33e3, 45e3, 40e3;
  out.config.design = with_proportional_damping(s, table, theta, kSpaceDamping);
  out.config.axes = axes_on(s, {1, 2});
  return out;
}

StudyBuilding stories_with_channels(int stories, const std::vector<int>& floors) {
  StudyBuilding out{fmt::format("{} stories, {} of them measured", stories, floors.size()), {}};
  estimator::Structure& s = out.config.structure;
  s.name = fmt::format("{} stories", stories);
  s.stories = stories;
  s.frames_x = {"y1"};
  s.story_height.assign(static_cast<std::size_t>(stories), 3.5);
  s.node_mass.assign(static_cast<std::size_t>(stories), 800e3);
  const estimator::ParameterTable table(s);
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(table.size());
  for (int story = 0; story < stories; ++story)
    theta[story] = 1e9 * (1 - (1 - kTopShare) * story / (stories - 1.0));
  const double wanted_hz = 1 / (kTallPeriod_s * stories);
  theta *= std::pow(wanted_hz / natural_frequencies_hz(s, table, theta).front(), 2);
  out.config.design = with_proportional_damping(s, table, theta, kTallDamping);
  out.config.axes = axes_on(s, floors);
  return out;
}

void set_noise(const std::vector<double>& sigma, estimator::PipelineConfig& config) {
  for (std::size_t a = 0; a < config.axes.size(); ++a)
    config.axes[a].noise_density = sigma[a] / std::sqrt(config.options.rate_hz / 2);
}

Eigen::VectorXd design_off(const estimator::PipelineConfig& config, double off,
                           std::uint64_t seed) {
  estimator::Random random(seed);
  const estimator::Structure& s = config.structure;
  const estimator::ParameterTable identified = config.parameters(), stories(s);
  Eigen::VectorXd factor(identified.size()), out = config.design;
  for (double& f : factor) f = 1 + off * (2 * random.uniform() - 1);
  for (int p = 0; p < stories.size(); ++p) {
    const estimator::Parameter& story = stories[p];
    int of = p;
    if (identified.grouped()) {
      of = identified.frame_stiffness(story.story, story.frame);
      if (story.kind == estimator::ParameterKind::frame_damping) of += identified.elements();
    }
    out[p] *= factor[of];
  }
  return out;
}

}  // namespace framewatch::earthquake
