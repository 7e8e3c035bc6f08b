// SPDX-License-Identifier: MIT
#include "estimator/diagnose/model/model.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "estimator/numeric/solve.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kBendingStep = 0.1, kMaxBending = 100;  ///< of the design's flexibility

}  // namespace

LawValues ModelEffect::law(std::size_t record) const {
  LawValues out{form, {}, deformation, rate, 1.0};
  for (const LawParameter& parameter : parameters) out.p.push_back(parameter.plain());
  if (record < record_parameters.size())
    for (const LawParameter& parameter : record_parameters[record])
      out.p.push_back(parameter.plain());
  return out;
}

bool has_element_law(const Model& model) {
  return std::any_of(model.effects.begin(), model.effects.end(),
                     [](const ModelEffect& e) { return e.element_law(); });
}

Model initial_model(const Plant& plant) {
  Model out;
  out.theta = plant.design;
  out.mass_change = VectorXd::Zero(plant.equations());
  out.gain = VectorXd::Zero(plant.axis_count());
  out.clock_s = VectorXd::Zero(plant.axis_count());
  for (Index a = 0; a < plant.axis_count(); ++a)
    out.clock_s[a] = plant.axes[static_cast<std::size_t>(a)].delay;
  for (const Direction along : {Direction::x, Direction::y}) {
    const double stiffness = plant.bending[along == Direction::x ? 0 : 1];
    if (!(stiffness > 0)) continue;
    ModelEffect bending;
    bending.form = LawForm::bending;
    bending.place.kind = PlaceKind::building;
    bending.place.direction = along;
    bending.parameters = {
        bounded_parameter(1 / stiffness, kBendingStep / stiffness, 0, kMaxBending / stiffness)};
    bending.parameters[0].sigma = bending.parameters[0].center = 1 / stiffness;
    out.effects.push_back(bending);
  }
  return out;
}

int element_of(const Plant& plant, const EffectPlace& place) {
  return place.kind == PlaceKind::panel ? plant.table.panel_stiffness(place.story, place.panel)
                                        : plant.table.frame_stiffness(place.story, place.frame);
}

std::vector<int> frames_at(const Structure& s, int crossing) {
  const int columns = std::max(s.m(), 1);
  std::vector<int> out;
  if (s.n() > 0) out.push_back(crossing / columns);
  if (s.m() > 0) out.push_back(s.n() + crossing % columns);
  return out;
}

VectorXd node_direction(const Plant& plant, int story, int frame) {
  return plant.constraint.row(plant.structure.dof(story, frame)).transpose();
}

MatrixXd hinges(const Plant& plant, const ModelEffect& effect) {
  const Structure& s = plant.structure;
  const bool bending = effect.form == LawForm::bending;
  std::vector<VectorXd> rows;
  const auto along = static_cast<std::size_t>(effect.place.direction == Direction::x ? 0 : 1);
  const auto add = [&](int frame, int above) {
    VectorXd row = VectorXd::Zero(plant.element_count());
    for (const Element& e : plant.elements)
      if (e.frame >= 0 && s.direction(e.frame) == effect.place.direction &&
          (frame < 0 || e.frame == frame) && e.story > above)
        row[e.stiffness] = s.story_height[static_cast<std::size_t>(e.story - 1)];
    rows.push_back(row);
  };
  if (!bending) {
    add(-1, 0);
  } else {
    for (int f = 0; f < s.frames(); ++f)
      if (s.direction(f) == effect.place.direction)
        for (int j = 0; j < s.stories; ++j) {
          add(f, j);
          if (plant.bending[along] > 0)
            rows.back() *= std::sqrt(plant.bending[along] /
                                     plant.bending.of_floor(along, static_cast<std::size_t>(j)));
        }
  }
  MatrixXd out(static_cast<Index>(rows.size()), plant.element_count());
  for (std::size_t r = 0; r < rows.size(); ++r) out.row(static_cast<Index>(r)) = rows[r];
  return out;
}

HingedElements hinged_elements(const Plant& plant, const Model& model, const ModelEffect& effect) {
  // d = q - H' phi, (1/size) phi = H k d: size is the flexibility 1/K.
  const double size = effect.parameters[0].plain();
  const Index n = plant.element_count();
  const MatrixXd h = hinges(plant, effect);
  const VectorXd k = model.theta.head(n), c = model.theta.tail(n);
  const MatrixXd hk = h * k.asDiagonal();
  MatrixXd inner = size * hk * h.transpose();
  inner.diagonal().array() += 1;
  const MatrixXd turn = size * solve_lu(inner, hk);  // phi = turn q
  const MatrixXd kept = MatrixXd::Identity(n, n) - h.transpose() * turn;
  HingedElements out{k.asDiagonal() * kept, kept.transpose() * c.asDiagonal() * kept};
  out.stiffness.diagonal() -= k;
  out.damping.diagonal() -= c;
  return out;
}

}  // namespace framewatch::estimator
