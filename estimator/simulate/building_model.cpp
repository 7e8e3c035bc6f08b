// SPDX-License-Identifier: MIT
#include "estimator/simulate/building_model.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "estimator/numeric/eigenvalues.h"
#include "estimator/numeric/solve.h"
#include "estimator/simulate/make_law.h"
#include "estimator/simulate/random.h"
#include "estimator/structure/matrices.h"

namespace framewatch::estimator {
namespace {

constexpr int kTones = 100;  ///< one in each of as many equal parts of the band

/// The effect of each rotation on each frame story: the story's height if it lies above the
/// rotation.
struct Kinematics {
  std::vector<std::size_t> frames;  ///< elements of model.linear
  Eigen::MatrixXd height;           ///< frame stories x rotations, m
  Eigen::VectorXd spring;           ///< of the rotations, N*m/rad
};

Kinematics kinematics(const Structure& s, const ParameterTable& table, Direction direction,
                      double base_stiffness, const std::vector<double>& hinge_stiffness) {
  Kinematics out;
  const int first = direction == Direction::x ? 0 : s.n();
  const int count = direction == Direction::x ? s.n() : s.m();
  const int base = base_stiffness > 0 ? 1 : 0;
  const auto hinges = static_cast<int>(hinge_stiffness.size());
  out.height = Eigen::MatrixXd::Zero(count * s.stories, base + count * hinges);
  out.spring = Eigen::VectorXd::Zero(out.height.cols());
  for (int f = 0; f < count; ++f)
    for (int floor = 0; floor < hinges; ++floor)
      out.spring[base + f * hinges + floor] = hinge_stiffness[static_cast<std::size_t>(floor)];
  if (base) out.spring[0] = base_stiffness;
  for (int f = 0; f < count; ++f) {
    for (int story = 1; story <= s.stories; ++story) {
      const double h = s.story_height[static_cast<std::size_t>(story - 1)];
      const auto row = static_cast<Eigen::Index>(out.frames.size());
      if (base) out.height(row, 0) = h;
      for (int floor = 0; floor < std::min(story, hinges); ++floor)
        out.height(row, base + f * hinges + floor) = h;
      out.frames.push_back(static_cast<std::size_t>(table.frame_stiffness(story, first + f)));
    }
  }
  return out;
}

/// Applies base_rocking and frame_bending along one direction: replaces the frames' deformations in
/// model.linear by those relative to the rotations and adds the rotational springs. The rotations
/// have no inertia and follow the elastic moments (docs/effects.md). base_stiffness 0 and no hinges
/// mean no such rotation.
void add_rotations(const Structure& s, const ParameterTable& table, Direction direction,
                   double base_stiffness, const std::vector<double>& hinges, LinearModel& model) {
  const Kinematics k = kinematics(s, table, direction, base_stiffness, hinges);
  const auto rows = static_cast<Eigen::Index>(k.frames.size());
  Eigen::MatrixXd drift(rows, model.mass.size());
  Eigen::VectorXd stiffness(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const LinearElement& frame = model.linear[k.frames[static_cast<std::size_t>(i)]];
    drift.row(i) = frame.b.transpose();
    stiffness[i] = frame.stiffness;
  }
  const Eigen::MatrixXd moment_arm = k.height.transpose() * stiffness.asDiagonal();
  Eigen::MatrixXd rotational = moment_arm * k.height;
  rotational.diagonal() += k.spring;
  const Eigen::MatrixXd rotation = Ldlt(rotational).solve(Eigen::MatrixXd(moment_arm * drift));
  const Eigen::MatrixXd deformation = drift - k.height * rotation;
  for (Eigen::Index i = 0; i < rows; ++i)
    model.linear[k.frames[static_cast<std::size_t>(i)]].b = deformation.row(i).transpose();
  for (Eigen::Index r = 0; r < rotation.rows(); ++r)
    model.linear.push_back({rotation.row(r).transpose(), k.spring[r], 0});
}

using enum EffectKind;

std::vector<const Effect*> of_kind(const std::vector<Effect>& effects, EffectKind kind) {
  std::vector<const Effect*> out;
  for (const Effect& e : effects)
    if (e.kind == kind) out.push_back(&e);
  return out;
}

Structure with_extra_mass(Structure s, const std::vector<Effect>& effects) {
  const int crossings = s.nodes() / s.stories;
  for (const Effect* e : of_kind(effects, extra_mass))
    s.node_mass[static_cast<std::size_t>((e->place.story - 1) * crossings + e->place.crossing)] +=
        e->value("mass_kg");
  return s;
}

Eigen::VectorXd dense(const Element& element, Eigen::Index size) {
  Eigen::VectorXd b = Eigen::VectorXd::Zero(size);
  for (const auto& [dof, coefficient] : element.b) b[dof] = coefficient;
  return b;
}

/// Returns the columns of `rigid` that move no flexible floor, and one column for every degree of
/// freedom of the flexible floors.
Eigen::MatrixXd freed(const Structure& s, const Eigen::MatrixXd& rigid,
                      const std::vector<bool>& flexible) {
  if (s.floor == FloorModel::flexible) return rigid;
  std::vector<Eigen::VectorXd> columns;
  for (int story = 1; story <= s.stories; ++story) {
    const int first = s.dof(story, 0);
    if (flexible[static_cast<std::size_t>(story)]) {
      for (int f = 0; f < s.frames(); ++f)
        columns.push_back(Eigen::VectorXd::Unit(rigid.rows(), first + f));
      continue;
    }
    for (Eigen::Index c = 0; c < rigid.cols(); ++c)
      if (rigid.col(c).segment(first, s.frames()).any()) columns.push_back(rigid.col(c));
  }
  Eigen::MatrixXd out(rigid.rows(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t c = 0; c < columns.size(); ++c)
    out.col(static_cast<Eigen::Index>(c)) = columns[c];
  return out;
}

/// Adds the panels of the floors that are flexible although the building's floors are rigid.
void add_flexible_floors(const Structure& s, const std::vector<Effect>& effects,
                         LinearModel& model) {
  Structure flexible = s;
  flexible.floor = FloorModel::flexible;
  std::vector<bool> flexes(static_cast<std::size_t>(s.stories) + 1, false);
  for (const Effect* e : of_kind(effects, floor_flexibility)) {
    flexes[static_cast<std::size_t>(e->place.story)] = true;
    for (const Element& panel : elements(flexible, ParameterTable(flexible)))
      if (panel.panel >= 0 && panel.story == e->place.story)
        model.linear.push_back(
            {dense(panel, model.mass.size()), e->value("gk_nprad"), e->value("gc_nsprad")});
  }
  const Eigen::MatrixXd floors = freed(s, floor_constraint(s), flexes);
  const Eigen::Index hidden = model.mass.size() - s.degrees_of_freedom();
  model.constraint = Eigen::MatrixXd::Zero(model.mass.size(), floors.cols() + hidden);
  model.constraint.topLeftCorner(floors.rows(), floors.cols()) = floors;
  model.constraint.bottomRightCorner(hidden, hidden).setIdentity();
}

void add_hidden_masses(const Structure& s, const std::vector<Effect>& effects, LinearModel& model) {
  Eigen::Index dof = s.degrees_of_freedom();
  for (const Effect* e : of_kind(effects, tuned_mass_damper)) {
    const double mass = e->value("mass_kg");
    const double omega = 2 * M_PI * e->value("frequency_hz");
    const int node = s.dof(e->place.story, e->place.frame);
    // A mass of 0 keeps its degree of freedom: it moves, but exerts no force.
    model.mass[dof] = mass > 0 ? mass : 1;
    model.influence.row(dof) = model.influence.row(node);
    Eigen::VectorXd b = Eigen::VectorXd::Unit(model.mass.size(), dof);
    if (mass > 0) b[node] = -1;
    model.linear.push_back({b, model.mass[dof] * omega * omega,
                            2 * e->value("damping_ratio") * model.mass[dof] * omega});
    ++dof;
  }
}

void add_node_pairs(const Structure& s, const std::vector<Effect>& effects, LinearModel& model) {
  for (const Effect& e : effects) {
    if (e.kind != added_spring && e.kind != added_damper) continue;
    Eigen::VectorXd b =
        Eigen::VectorXd::Unit(model.mass.size(), s.dof(e.place.story, e.place.frame));
    if (e.place.to_story > 0) b[s.dof(e.place.to_story, e.place.frame)] = -1;
    model.linear.push_back({b, e.kind == added_spring ? e.value("k_npm") : 0,
                            e.kind == added_damper ? e.value("c_nspm") : 0});
  }
}

/// Call before effects other than rotations are added.
void add_modal_damping(const Structure& s, const std::vector<Effect>& effects, LinearModel& model) {
  const std::vector<const Effect*> ratios = of_kind(effects, modal_damping);
  if (ratios.empty()) return;
  const int nd = s.degrees_of_freedom();
  const Eigen::VectorXd mass = frame_masses(s);
  const Eigen::MatrixXd floors = floor_constraint(s);
  const RealEigen modes =
      generalized_eigen(floors.transpose() * model.stiffness().topLeftCorner(nd, nd) * floors,
                        floors.transpose() * mass.asDiagonal() * floors);
  for (const Effect* e : ratios) {
    const Eigen::Index at = e->place.mode - 1;
    Eigen::VectorXd b = Eigen::VectorXd::Zero(model.mass.size());
    b.head(nd) = mass.cwiseProduct(floors * modes.vectors.col(at));
    model.linear.push_back(
        {b, 0, 2 * e->value("damping_ratio") * std::sqrt(std::max(modes.values[at], 0.0))});
  }
}

/// Returns the stiffness of all rotational springs of one kind in series; 0: no such spring.
double rotational_stiffness(const std::vector<Effect>& effects, EffectKind kind,
                            Direction direction) {
  double flexibility = 0;
  for (const Effect* e : of_kind(effects, kind))
    if (e->place.direction == direction) flexibility += 1 / e->value("kr_nmprad");
  return flexibility > 0 ? 1 / flexibility : 0;
}

}  // namespace

double rocking_stiffness(const std::vector<Effect>& effects, Direction direction) {
  return rotational_stiffness(effects, base_rocking, direction);
}

std::vector<double> hinge_stiffness(const Structure& s, const std::vector<Effect>& effects,
                                    const BendingStiffness& bending, Direction direction) {
  const double effect = rotational_stiffness(effects, frame_bending, direction);
  const std::size_t along = direction == Direction::x ? 0 : 1;
  if (!(effect > 0) && !(bending[along] > 0)) return {};
  std::vector<double> out(static_cast<std::size_t>(s.stories), effect);
  for (std::size_t floor = 0; floor < out.size() && bending[along] > 0; ++floor) {
    const double design = bending.of_floor(along, floor);
    out[floor] = effect > 0 ? 1 / (1 / effect + 1 / design) : design;
  }
  return out;
}

AppliedForce::AppliedForce(const Effect& e) : from_s_(e.value("from_s")) {
  if (e.value("amplitude_n") > 0)
    tones_.push_back(
        {e.value("amplitude_n"), 2 * M_PI * e.value("frequency_hz"), e.value("phase_rad")});
  if (e.value("rms_n") <= 0) return;
  Random random(static_cast<std::uint64_t>(e.value("seed")), 0);
  const double low_hz = e.value("low_hz");
  const double part_hz = (e.value("high_hz") - low_hz) / kTones;
  for (int i = 0; i < kTones; ++i) {
    const double frequency_hz = low_hz + part_hz * (i + random.uniform());
    const double phase = 2 * M_PI * random.uniform();
    tones_.push_back({e.value("rms_n") * std::sqrt(2.0 / kTones), 2 * M_PI * frequency_hz, phase});
  }
}

double AppliedForce::at(double time_s) const {
  double sum = 0;
  for (const Tone& tone : tones_)
    sum += tone.amplitude * std::sin(tone.omega * time_s + tone.phase);
  return sum;
}

Eigen::MatrixXd LinearModel::stiffness() const {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(mass.size(), mass.size());
  for (const LinearElement& e : linear) out += e.stiffness * e.b * e.b.transpose();
  return out;
}

Eigen::MatrixXd LinearModel::damping() const {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(mass.size(), mass.size());
  for (const LinearElement& e : linear) out += e.damping * e.b * e.b.transpose();
  return out;
}

LinearModel linear_model(const Structure& structure, const ParameterTable& table,
                         const Eigen::VectorXd& theta, const std::vector<Effect>& effects) {
  return linear_model(structure, table, theta, effects, ground_influence(structure));
}

LinearModel linear_model(const Structure& structure, const ParameterTable& table,
                         const Eigen::VectorXd& theta, const std::vector<Effect>& effects,
                         const Eigen::MatrixXd& influence, const BendingStiffness& bending) {
  const Structure s = with_extra_mass(structure, effects);
  const int nd = s.degrees_of_freedom();
  const auto size = nd + static_cast<Eigen::Index>(of_kind(effects, tuned_mass_damper).size());
  LinearModel model{
      Eigen::VectorXd::Zero(size), Eigen::MatrixXd::Zero(size, influence.cols()), {}, {}};
  model.influence.topRows(nd) = influence;
  model.mass.head(nd) = frame_masses(s);
  for (const Element& e : elements(s, table))
    model.linear.push_back(
        {dense(e, size), theta[e.stiffness], theta[e.stiffness + table.elements()]});
  for (const Direction direction : {Direction::x, Direction::y}) {
    const double base = rocking_stiffness(effects, direction);
    const std::vector<double> hinges = hinge_stiffness(s, effects, bending, direction);
    if (base > 0 || !hinges.empty()) add_rotations(s, table, direction, base, hinges, model);
  }
  add_modal_damping(structure, effects, model);
  add_hidden_masses(s, effects, model);
  add_node_pairs(s, effects, model);
  add_flexible_floors(s, effects, model);
  return model;
}

Eigen::VectorXd PlacedLaw::deformation(const LinearModel& model) const {
  if (element >= 0) return model.linear[static_cast<std::size_t>(element)].b;
  Eigen::VectorXd b = Eigen::VectorXd::Unit(model.mass.size(), between[0]);
  if (between.size() > 1) b[between[1]] = -1;
  return b;
}

std::vector<PlacedLaw> placed_laws(const Structure& s, const ParameterTable& table,
                                   const Eigen::VectorXd& theta,
                                   const std::vector<Effect>& effects) {
  std::vector<PlacedLaw> out;
  for (const Effect& e : effects) {
    if (e.kind == amplitude_dependence) {
      for (int story = 1; story <= s.stories; ++story)
        for (int f = 0; f < s.frames(); ++f) {
          const bool own = e.place.kind == PlaceKind::whole_frame
                               ? f == e.place.frame
                               : s.direction(f) == e.place.direction;
          const int element = table.frame_stiffness(story, f);
          if (own) out.push_back({element, make_amplitude_law(e, theta[element]), {}});
        }
      continue;
    }
    std::unique_ptr<ElementLaw> law = make_law(e, s);
    if (!law) continue;
    if (e.place.kind == PlaceKind::node_pair) {
      out.push_back({-1, std::move(law), {s.dof(e.place.story, e.place.frame)}});
      if (e.place.to_story > 0)
        out.back().between.push_back(s.dof(e.place.to_story, e.place.frame));
      continue;
    }
    const int element = e.place.kind == PlaceKind::panel
                            ? table.panel_stiffness(e.place.story, e.place.panel)
                            : table.frame_stiffness(e.place.story, e.place.frame);
    out.push_back({element, std::move(law), {}});
  }
  return out;
}

std::vector<PlacedForce> placed_forces(const Structure& s, const std::vector<Effect>& effects) {
  std::vector<PlacedForce> out;
  for (const Effect* e : of_kind(effects, unmeasured_force))
    out.push_back({s.dof(e->place.story, e->place.frame), AppliedForce(*e)});
  return out;
}

bool stands(const Structure& s, const ParameterTable& table, const Eigen::VectorXd& theta,
            const std::vector<Effect>& effects) {
  const LinearModel model = linear_model(s, table, theta, effects);
  Eigen::MatrixXd stiffness = model.stiffness();
  for (const Effect& e : effects) {
    const bool losing = e.kind == stiffness_drop || e.kind == stiffness_drift;
    const std::vector<PlacedLaw> placed =
        losing || e.kind == p_delta ? placed_laws(s, table, theta, {e}) : std::vector<PlacedLaw>{};
    for (const PlacedLaw& p : placed) {
      const bool gaining = losing && e.value("dk_npm") > 0;
      const Eigen::VectorXd& b = model.linear[static_cast<std::size_t>(p.element)].b;
      if (!gaining) stiffness -= p.law->stiffness_bound() * b * b.transpose();
    }
  }
  const Eigen::MatrixXd reduced = model.constraint.transpose() * stiffness * model.constraint;
  return symmetric_eigenvalues(reduced).minCoeff() > 0;
}

bool concerns_building(const std::vector<Effect>& effects) {
  return std::any_of(effects.begin(), effects.end(),
                     [](const Effect& e) { return !is_channel_effect(e.kind); });
}

}  // namespace framewatch::estimator
