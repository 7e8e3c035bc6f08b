#include "estimator/diagnose/model.h"

#include <cmath>

#include <Eigen/LU>

#include "estimator/structure/complex.h"

namespace framewatch {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Absolute motion of the ground under a frame, as a row over the axes.
Eigen::RowVectorXd ground_row(const Plant& plant, int frame) {
  return plant.ground.row(plant.structure.dof(1, frame));
}

/// Heights h and hinge membership: rows hinges x elements, entry h_i where the hinge turns element
/// i.
MatrixXd hinges(const Plant& plant, const ModelEffect& effect) {
  const Structure& s = plant.structure;
  const bool bending = effect.form == LawForm::bending;
  std::vector<VectorXd> rows;
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
        for (int j = 0; j < s.stories; ++j) add(f, j);
  }
  MatrixXd out(static_cast<Index>(rows.size()), plant.element_count());
  for (std::size_t r = 0; r < rows.size(); ++r) out.row(static_cast<Index>(r)) = rows[r];
  return out;
}

}  // namespace

double Knob::plain() const {
  return logarithmic ? std::exp(value) : value;
}

LawValues ModelEffect::law(std::size_t record) const {
  LawValues out{form, {}, deformation, rate};
  for (const Knob& knob : knobs) out.p.push_back(knob.plain());
  if (record < record_knobs.size())
    for (const Knob& knob : record_knobs[record]) out.p.push_back(knob.plain());
  return out;
}

Model initial_model(const Plant& plant) {
  Model out;
  out.theta = plant.design;
  out.mass_change = VectorXd::Zero(plant.equations());
  out.gain = VectorXd::Zero(plant.axis_count());
  out.clock_s = VectorXd::Zero(plant.axis_count());
  for (Index a = 0; a < plant.axis_count(); ++a)
    out.clock_s[a] = plant.axes[static_cast<std::size_t>(a)].delay;
  return out;
}

int element_of(const Plant& plant, const EffectPlace& place) {
  return place.kind == PlaceKind::panel ? plant.table.panel_stiffness(place.story, place.panel)
                                        : plant.table.frame_stiffness(place.story, place.frame);
}

VectorXd node_direction(const Plant& plant, int story, int frame) {
  return plant.constraint.row(plant.structure.dof(story, frame)).transpose();
}

MatrixXcd linear_operation(const Plant& plant, const Model& model, const ModelEffect& effect,
                           double w) {
  const Structure& s = plant.structure;
  const EffectPlace& place = effect.place;
  const double size = effect.knobs.empty() ? 0 : effect.knobs[0].plain();
  MatrixXcd out = MatrixXcd::Zero(plant.equations(), plant.axis_count());
  switch (effect.form) {
    case LawForm::mass: {
      const int columns = std::max(s.m(), 1);
      const int y = place.crossing / columns, x = place.crossing % columns;
      for (const int frame : {s.n() > 0 ? y : -1, s.m() > 0 ? s.n() + x : -1}) {
        if (frame < 0) continue;
        const VectorXd at = node_direction(plant, place.story, frame);
        out += size * at * (at.transpose() * plant.motion);
      }
      break;
    }
    case LawForm::resonator: {
      const double wr = 2 * M_PI * effect.knobs[1].plain();
      const Complex spring = wr * wr + 2.0 * effect.knobs[2].plain() * wr * w * kJ;
      const VectorXd at = node_direction(plant, place.story, place.frame);
      out = size * spring / (spring - w * w) * (at * (at.transpose() * plant.motion));
      break;
    }
    case LawForm::spring:
    case LawForm::damper: {
      VectorXd at = node_direction(plant, place.story, place.frame);
      Eigen::RowVectorXd sense = at.transpose() * plant.motion;
      if (place.to_story > 0) {
        const VectorXd lower = node_direction(plant, place.to_story, place.frame);
        at -= lower;
        sense -= lower.transpose() * plant.motion;
      } else {
        sense -= ground_row(plant, place.frame);
      }
      const Complex factor =
          effect.form == LawForm::spring ? Complex(-size / (w * w)) : size / (kJ * w);
      out = factor * (at * sense);
      break;
    }
    case LawForm::panels:
      for (const Element& e : plant.elements) {
        if (e.panel < 0 || e.story != place.story) continue;
        const Index at = e.stiffness;
        const Complex change =
            (size - model.theta[at]) / -(w * w) +
            (effect.knobs[1].plain() - model.theta[at + plant.element_count()]) / (kJ * w);
        out += change * (plant.building.act.col(at) * plant.building.sense.row(at));
      }
      break;
    case LawForm::rocking:
    case LawForm::bending: {
      // d = q - H' phi, (1/size) phi = H k d: size is the flexibility 1/K.
      const Index n = plant.element_count();
      const MatrixXd h = hinges(plant, effect);
      const VectorXd k = model.theta.head(n), c = model.theta.tail(n);
      const MatrixXd hk = h * k.asDiagonal();
      MatrixXd inner = size * hk * h.transpose();
      inner.diagonal().array() += 1;
      const MatrixXd turn = size * inner.partialPivLu().solve(hk);  // phi = turn q
      const MatrixXd kept = MatrixXd::Identity(n, n) - h.transpose() * turn;
      MatrixXd stiff = k.asDiagonal() * kept;
      stiff.diagonal() -= k;
      MatrixXd damped = kept.transpose() * c.asDiagonal() * kept;
      damped.diagonal() -= c;
      const MatrixXcd change = -stiff.cast<Complex>() / (w * w) + damped.cast<Complex>() / (kJ * w);
      out = plant.building.act.cast<Complex>() * change * plant.building.sense.cast<Complex>();
      break;
    }
    default:
      break;
  }
  return out;
}

}  // namespace framewatch
