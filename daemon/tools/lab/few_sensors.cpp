// SPDX-License-Identifier: MIT
#include "daemon/tools/lab/few_sensors.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>

#include <fmt/core.h>

#include "daemon/monitor/estimation/estimation.h"
#include "estimator/numeric/nan.h"
#include "estimator/simulate/linear_response.h"
#include "estimator/simulate/random.h"
#include "estimator/simulate/sensor_model.h"
#include "estimator/structure/group_design.h"

namespace framewatch::daemon {
namespace {

constexpr double kEvery_s = 5, kNormal95 = 1.96;
constexpr std::uint64_t kAcross = 5000;  // offset of the seed for ground motion along y

double between(estimator::Random& random, double most) {
  return most * (2 * random.uniform() - 1);
}

/// Draws the true parameters, in the order of the stories' table, and the masses as far off the
/// design as the trial demands.
void draw(const TallTrial& t, estimator::Structure& s, Eigen::VectorXd& theta) {
  estimator::Random random(1000 + t.seed);
  const estimator::ParameterTable table(s);
  int below = 0;
  std::vector<int> floors = t.floors;
  if (floors.back() < t.stories) floors.push_back(t.stories);
  for (const int floor : floors) {
    for (int f = 0; f < s.frames(); ++f) {
      const double k = 1 + between(random, t.stiffness_off);
      const double c = 1 + between(random, t.damping_off);
      for (int story = below + 1; story <= floor; ++story) {
        theta[table.frame_stiffness(story, f)] *= k;
        theta[table.frame_damping(story, f)] *= c;
      }
    }
    below = floor;
  }
  const std::size_t nodes = s.node_mass.size() / static_cast<std::size_t>(t.stories);
  for (int story = 1; story <= t.stories; ++story) {
    const double profile = std::exp(t.profile_off * random.normal());
    for (int f = 0; f < s.frames(); ++f) {
      theta[table.frame_stiffness(story, f)] *= profile;
      theta[table.frame_damping(story, f)] *= profile;
    }
    const double mass = std::exp(t.mass_off * random.normal());
    for (std::size_t n = 0; n < nodes; ++n)
      s.node_mass[static_cast<std::size_t>(story - 1) * nodes + n] *= mass;
  }
}

/// Puts the building on uneven soil: an additional soft story below it lets its base turn.
void put_on_soil(estimator::Structure& s, Eigen::VectorXd& theta,
                 std::vector<estimator::SensorAxis>& axes) {
  constexpr double kSoil[] = {2.5, 0.8, 0.8, 2.5};  // times the lowest story, by frame
  constexpr double kSoilDamping_s = 0.01;           // damping over stiffness
  const estimator::Structure above = s;
  const estimator::ParameterTable before(above);
  s.stories += 1;
  s.story_height.insert(s.story_height.begin(), 1.0);
  s.node_mass.insert(s.node_mass.begin(), above.node_mass.begin(), above.node_mass.begin() + 4);
  const estimator::ParameterTable table(s);
  Eigen::VectorXd out(table.size());
  for (int f = 0; f < s.frames(); ++f) {
    out[table.frame_stiffness(1, f)] = kSoil[f] * theta[before.frame_stiffness(1, f)];
    out[table.frame_damping(1, f)] = kSoilDamping_s * out[table.frame_stiffness(1, f)];
    for (int story = 1; story <= above.stories; ++story) {
      out[table.frame_stiffness(story + 1, f)] = theta[before.frame_stiffness(story, f)];
      out[table.frame_damping(story + 1, f)] = theta[before.frame_damping(story, f)];
    }
  }
  theta = out;
  for (estimator::SensorAxis& axis : axes) axis.story += 1;
}

void run_rows(const std::string& what, int seeds, const Workers& workers,
              std::vector<FewSensorsRow>& rows) {
  std::mutex mutex;
  workers.run(what, static_cast<int>(rows.size()) * seeds, [&](int piece) {
    TallTrial trial = rows[static_cast<std::size_t>(piece / seeds)].trial;
    trial.seed = static_cast<std::uint64_t>(piece % seeds + 1);
    const FewSensorsErrors errors = few_sensors_errors(tall_record(trial), trial.from_s);
    const std::lock_guard lock(mutex);
    rows[static_cast<std::size_t>(piece / seeds)].errors.add(errors);
  });
}

}  // namespace

TallRecord tall_record(const TallTrial& t) {
  TallRecord out;
  out.config.structure = t.in_space ? tall_building_in_space(t.stories) : tall_building(t.stories);
  out.config.design = t.in_space ? tall_design_in_space(t.stories) : tall_design(t.stories);
  out.config.axes = t.in_space ? floor_axes_in_space(t.floors) : floor_axes(t.floors);
  out.config.bending_nmprad.base_nmprad[0] = t.believed_bending_nmprad;
  out.config.options.rate_hz = kTrialRate_hz;
  estimator::Structure truly = out.config.structure;
  Eigen::VectorXd theta = out.config.design;
  draw(t, truly, theta);
  const estimator::ParameterTable table = out.config.parameters();
  out.truth = group_parameters(truly, table, {theta, {{t.bending_nmprad, 0}, {}}});
  std::vector<estimator::SensorAxis> sensors = out.config.axes;
  if (t.in_space) put_on_soil(truly, theta, sensors);
  const estimator::ParameterTable stories(truly);

  estimator::KanaiTajimi ground;
  ground.peak_mps2 = 3;
  ground.duration_s = t.duration_s + 1;
  ground.build_up_s = 3;
  ground.strong_s = t.duration_s;
  ground.step_s = 1e-3;
  ground.seed = t.seed;
  std::vector<estimator::Effect> effects = t.hidden;
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
  estimator::PlanMotion shaking = directed(kanai_tajimi(ground), 0);
  if (t.in_space) {
    ground.seed += kAcross;
    shaking.y = kanai_tajimi(ground);
  }
  estimator::ResponseStream response(truly, stories, theta, shaking, options, {},
                                     response_channels(truly, sensors), effects);
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

std::string FewSensorsRow::must() const {
  return most_k > 0 ? fmt::format("{:g} %, {:g} %", 100 * most_k, 100 * most_c) : "-";
}

double FewSensorsErrors::held_ratio() const {
  return stiffness.published > 0 ? static_cast<double>(held) / stiffness.published
                                 : estimator::kNaN;
}

void FewSensorsErrors::add(const FewSensorsErrors& other) {
  stiffness.add(other.stiffness);
  damping.add(other.damping);
  held += other.held;
}

FewSensorsErrors few_sensors_errors(const TallRecord& record, double from_s) {
  const estimator::ParameterTable table = record.config.parameters();
  std::vector<estimator::WindowEstimate> estimates;
  FewSensorsErrors out;
  for (const CheckedWindow& w :
       run_checked_windows(with_design_error(record.config), record.accel, from_s, kEvery_s)) {
    estimates.push_back(w.estimate);
    for (int p = 0; p < table.elements(); ++p) {
      const auto i = static_cast<std::size_t>(p);
      if (w.estimate.reason[i] != estimator::Observability::observable) continue;
      const double window = w.estimate.std_error[i] / w.estimate.value[i];
      const double model = std::isfinite(w.fit.error[i]) ? w.fit.error[i] : 0;
      const double off = std::abs(w.estimate.value[i] / record.truth[p] - 1);
      if (off < std::hypot(kStudent95 * window, kNormal95 * model)) ++out.held;
    }
  }
  ErrorsByKind errors;
  collect_errors(estimates, table, record.truth, errors);
  out.stiffness = errors[static_cast<std::size_t>(estimator::ParameterKind::frame_stiffness)];
  out.damping = errors[static_cast<std::size_t>(estimator::ParameterKind::frame_damping)];
  return out;
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
      if (floors.size() != 4 || floors.back() < 20) continue;
      rows.back().most_k = noise < 0.02 ? 0.0012 : 0.006;
      rows.back().most_c = noise < 0.02 ? 0.01 : 0.05;
    }
  }
  for (const double noise : {0.01, 0.05}) {
    TallTrial space;
    space.in_space = true;
    space.noise_ratio = noise;
    add(fmt::format("3 channels on 4 of 20 rigid floors, per frame, noise {:g} %", 100 * noise),
        space);
    if (noise < 0.02) rows.back().most_k = 0.001, rows.back().most_c = 0.01;
  }
  TallTrial hundred;
  hundred.stories = 100;
  hundred.floors = {25, 50, 75, 100};
  hundred.duration_s = 90;
  hundred.from_s = 50;
  add("4 of 100 floors, noise 1 %", hundred);
  TallTrial bending;
  bending.bending_nmprad = bending.believed_bending_nmprad = 3e12;
  bending.duration_s = 90;
  bending.from_s = 50;  // by then the held bending has been found
  add("4 of 20 floors, noise 1 %, frames bend", bending);
  bending.believed_bending_nmprad *= 2;
  add("4 of 20 floors, noise 1 %, frames bend, design twice as stiff in it", bending);
  run_rows("few sensors", seeds, workers, rows);
  return rows;
}

std::vector<FewSensorsRow> study_wrong_models(int seeds, const Workers& workers) {
  std::vector<FewSensorsRow> rows;
  for (const bool every_floor : {false, true}) {
    TallTrial right;
    right.stiffness_off = right.damping_off = 0.1;
    if (every_floor) {
      right.stories = 5;
      right.floors = {1, 2, 3, 4, 5};
    }
    const std::string where = every_floor ? "5 of 5 floors, " : "4 of 20 floors, ";
    const auto add = [&](const std::string& what, const TallTrial& trial) {
      rows.push_back({where + what, trial, {}});
    };
    add("the model is right", right);
    TallTrial wrong = right;
    wrong.mass_off = 0.02;
    add("masses off by 2 %", wrong);
    if (!every_floor) {
      wrong.profile_off = 0.05;
      add("masses off by 2 %, stories by 5 %", wrong);
    }
    for (const double stiffer : {10.0, 1.0, 0.1}) {
      TallTrial bends = right;
      bends.bending_nmprad = (every_floor ? 6e10 : 3e12) * stiffer;
      add(stiffer > 1   ? "frames bend a little"
          : stiffer < 1 ? "frames bend most"
                        : "frames bend",
          bends);
    }
    TallTrial damped = right;
    damped.ground_damping_ratio = 0.03;
    add("dashpots to the ground", damped);
  }
  run_rows("wrong models", seeds, workers, rows);
  return rows;
}

}  // namespace framewatch::daemon
