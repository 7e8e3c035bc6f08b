#include "daemon/lab/few_sensors.h"

#include <cmath>
#include <mutex>
#include <numbers>
#include <utility>

#include <fmt/core.h>

#include "estimator/simulate/linear_response.h"
#include "estimator/simulate/random.h"
#include "estimator/simulate/sensor_model.h"
#include "estimator/structure/group_design.h"
#include "estimator/structure/natural_frequencies.h"

namespace framewatch::daemon {
namespace {

constexpr double kFewSensorsDamping = 0.015, kTopShare = 0.35;
constexpr double kEvery_s = 5;

double between(estimator::Random& random, double most) {
  return most * (2 * random.uniform() - 1);
}

/// Truth in the order of the stories' table, and masses, both off the design as the trial says.
void draw(const TallTrial& t, estimator::Structure& s, Eigen::VectorXd& theta) {
  estimator::Random random(1000 + t.seed);
  int below = 0;
  std::vector<int> floors = t.floors;
  if (floors.back() < t.stories) floors.push_back(t.stories);
  for (const int floor : floors) {
    const double k = 1 + between(random, t.stiffness_off);
    const double c = 1 + between(random, t.damping_off);
    for (int story = below; story < floor; ++story) {
      theta[story] *= k;
      theta[t.stories + story] *= c;
    }
    below = floor;
  }
  for (int story = 0; story < t.stories; ++story) {
    const double profile = std::exp(t.profile_off * random.normal());
    theta[story] *= profile;
    theta[t.stories + story] *= profile;
    s.node_mass[static_cast<std::size_t>(story)] *= std::exp(t.mass_off * random.normal());
  }
}

}  // namespace

estimator::Structure tall_building(int stories) {
  estimator::Structure s;
  s.name = fmt::format("{} stories", stories);
  s.stories = stories;
  s.frames_x = {"y1"};
  s.story_height.assign(static_cast<std::size_t>(stories), 3.5);
  s.node_mass.assign(static_cast<std::size_t>(stories), 800e3);
  return s;
}

Eigen::VectorXd tall_design(int stories) {
  const estimator::Structure s = tall_building(stories);
  const estimator::ParameterTable table(s);
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(table.size());
  for (int story = 0; story < stories; ++story)
    theta[story] = 1e9 * (1 - (1 - kTopShare) * story / (stories - 1.0));
  theta.tail(stories) = theta.head(stories);
  const double f1_hz = 10.0 / stories;
  theta.head(stories) *= std::pow(f1_hz / natural_frequencies_hz(s, table, theta).front(), 2);
  theta.tail(stories) =
      theta.head(stories) * 2 * kFewSensorsDamping / (2 * std::numbers::pi * f1_hz);
  return theta;
}

std::vector<estimator::SensorAxis> floor_axes(const std::vector<int>& floors) {
  std::vector<estimator::SensorAxis> axes(1);
  axes[0].name = "base";
  for (const int floor : floors) {
    axes.emplace_back();
    axes.back().name = fmt::format("F{}", floor);
    axes.back().story = floor;
    axes.back().frame = 0;
  }
  return axes;
}

TallRecord tall_record(const TallTrial& t) {
  TallRecord out;
  out.config.structure = tall_building(t.stories);
  out.config.design = tall_design(t.stories);
  out.config.axes = floor_axes(t.floors);
  out.config.bending_nmprad = {t.believed_bending_nmprad, 0};
  out.config.options.rate_hz = kTrialRate_hz;
  estimator::Structure truly = out.config.structure;
  Eigen::VectorXd theta = out.config.design;
  draw(t, truly, theta);
  const estimator::ParameterTable stories(truly), table = out.config.parameters();
  out.truth = group_parameters(truly, table, {theta, {t.bending_nmprad, 0}});

  estimator::KanaiTajimi ground;
  ground.peak_mps2 = 3;
  ground.duration_s = t.duration_s + 1;
  ground.build_up_s = 3;
  ground.strong_s = t.duration_s;
  ground.step_s = 1e-3;
  ground.seed = t.seed;
  std::vector<estimator::Effect> effects;
  if (t.bending_nmprad > 0) {
    estimator::EffectPlace place;
    place.kind = estimator::PlaceKind::building;
    effects.push_back(make_effect(estimator::EffectKind::frame_bending, place));
    effects.back().set("kr_nmprad", t.bending_nmprad);
  }
  for (int story = 1; story <= t.stories && t.ground_damping_ratio > 0; ++story) {
    estimator::EffectPlace place;
    place.kind = estimator::PlaceKind::node;
    place.story = story;
    place.frame = 0;
    effects.push_back(make_effect(estimator::EffectKind::added_damper, place));
    effects.back().set("c_nspm", 4 * std::numbers::pi * (10.0 / t.stories) *
                                     t.ground_damping_ratio * truly.frame_mass(story, 0));
  }
  estimator::ResponseOptions options;
  options.rate_hz = kTrialRate_hz;
  estimator::ResponseStream response(truly, stories, theta, directed(kanai_tajimi(ground), 0),
                                     options, {}, response_channels(truly, out.config.axes),
                                     effects);
  const auto instants = static_cast<Eigen::Index>(t.duration_s * kTrialRate_hz) + 1;
  out.accel.resize(instants, static_cast<Eigen::Index>(out.config.axes.size()));
  for (Eigen::Index i = 0; i < instants; ++i) out.accel.row(i) = response.next().transpose();
  estimator::Random random(77 + t.seed);
  for (std::size_t a = 0; a < out.config.axes.size(); ++a) {
    auto column = out.accel.col(static_cast<Eigen::Index>(a));
    const double sigma = t.noise_ratio * std::sqrt(column.array().square().mean());
    // Without noise rows still need weights.
    out.config.axes[a].noise_density = std::max(sigma, 1e-9) / std::sqrt(kTrialRate_hz / 2);
    for (double& value : column) value += sigma * random.normal();
  }
  return out;
}

FewSensorsErrors few_sensors_errors(const TallRecord& record, double from_s) {
  const estimator::ParameterTable table = record.config.parameters();
  ErrorsByKind errors;
  collect_errors(run_windows(record.config, record.accel, from_s, kEvery_s), table, record.truth,
                 errors);
  return {errors[static_cast<std::size_t>(estimator::ParameterKind::frame_stiffness)],
          errors[static_cast<std::size_t>(estimator::ParameterKind::frame_damping)]};
}

std::vector<FewSensorsRow> study_few_sensors(int seeds, const Workers& workers) {
  std::vector<FewSensorsRow> rows;
  const auto add = [&](const std::string& name, const TallTrial& trial) {
    rows.push_back({name, trial, {}});
  };
  for (const double noise : {0.01, 0.05}) {
    const std::string of_noise = fmt::format("noise {:g} %", 100 * noise);
    for (const std::vector<int>& floors :
         std::vector<std::vector<int>>{{20},
                                       {10, 20},
                                       {5, 10, 15, 20},
                                       {3, 7, 10, 14, 17, 20},
                                       {2, 4, 6, 8, 10, 12, 14, 16, 18, 20},
                                       {4, 8, 12, 16}}) {
      TallTrial trial;
      trial.floors = floors;
      trial.noise_ratio = noise;
      add(fmt::format("{} of 20 floors{}, {}", floors.size(), floors.back() < 20 ? ", no roof" : "",
                      of_noise),
          trial);
    }
  }
  TallTrial wrong;
  wrong.profile_off = 0.05;
  wrong.mass_off = 0.02;
  add("4 of 20 floors, noise 1 %, stories off by 5 %, masses by 2 %", wrong);
  TallTrial bending;
  bending.bending_nmprad = bending.believed_bending_nmprad = 3e12;
  bending.duration_s = 90;
  bending.from_s = 50;  // what is held has been found
  add("4 of 20 floors, noise 1 %, frames bend", bending);
  bending.believed_bending_nmprad *= 2;
  add("4 of 20 floors, noise 1 %, frames bend, design twice as stiff in it", bending);

  std::mutex mutex;
  const int count = static_cast<int>(rows.size());
  workers.run("few sensors", count * seeds, [&](int piece) {
    TallTrial trial = rows[static_cast<std::size_t>(piece / seeds)].trial;
    trial.seed = static_cast<std::uint64_t>(piece % seeds + 1);
    const FewSensorsErrors errors = few_sensors_errors(tall_record(trial), trial.from_s);
    const std::lock_guard lock(mutex);
    FewSensorsRow& row = rows[static_cast<std::size_t>(piece / seeds)];
    row.errors.stiffness.add(errors.stiffness);
    row.errors.damping.add(errors.damping);
  });
  return rows;
}

}  // namespace framewatch::daemon
