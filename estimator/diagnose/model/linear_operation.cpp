// SPDX-License-Identifier: MIT
#include "estimator/diagnose/model/linear_operation.h"

#include <algorithm>
#include <cmath>

#include "estimator/diagnose/model/modal_damping.h"
#include "estimator/diagnose/model/model.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Returns the absolute motion of the ground under a frame, as a row over the axes.
Eigen::RowVectorXd ground_row(const Plant& plant, int frame) {
  return plant.ground.row(plant.structure.dof(1, frame));
}

}  // namespace

Complex transmissibility(const ModelEffect& resonator, double w) {
  const double wr = 2 * M_PI * resonator.parameters[1].plain();
  const Complex spring = wr * wr + 2.0 * resonator.parameters[2].plain() * wr * w * kJ;
  return spring / (spring - w * w);
}

LinearOperation::LinearOperation(const Plant& plant, const Model& model, const ModelEffect& effect)
    : rows_(plant.equations()), cols_(plant.building.axes()), effect_(effect) {
  using Factor = Shape::Factor;
  const Structure& s = plant.structure;
  const EffectPlace& place = effect.place;
  const double size = effect.parameters.empty() ? 0 : effect.parameters[0].plain();
  switch (effect.form) {
    case LawForm::mass: {
      MatrixXd inertia = MatrixXd::Zero(rows_, cols_);
      for (const int frame : frames_at(s, place.crossing)) {
        const VectorXd at = node_direction(plant, place.story, frame);
        inertia += size * at * (at.transpose() * plant.motion);
      }
      shapes_ = {{Factor::inertia, inertia}};
      break;
    }
    case LawForm::resonator: {
      const VectorXd at = node_direction(plant, place.story, place.frame);
      shapes_ = {{Factor::resonance, size * at * (at.transpose() * plant.motion)}};
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
      shapes_ = {{effect.form == LawForm::spring ? Factor::stiffness : Factor::damping,
                  size * at * sense}};
      break;
    }
    case LawForm::modal_damping:
      shapes_ = {{Factor::damping, modal_damping(plant, model, effect) * relative_motion(plant)}};
      break;
    case LawForm::panels: {
      MatrixXd stiff = MatrixXd::Zero(rows_, cols_), damped = stiff;
      for (const Element& e : plant.elements) {
        if (e.panel < 0 || e.story != place.story) continue;
        const Index at = e.stiffness;
        const MatrixXd one = plant.building.act.col(at) * plant.building.sense.row(at);
        stiff += (size - model.theta[at]) * one;
        damped += (effect.parameters[1].plain() - model.theta[at + plant.element_count()]) * one;
      }
      shapes_ = {{Factor::stiffness, stiff}, {Factor::damping, damped}};
      break;
    }
    case LawForm::rocking:
    case LawForm::bending: {
      const HingedElements change = hinged_elements(plant, model, effect);
      const MatrixXd &act = plant.building.act, &sense = plant.building.sense;
      shapes_ = {{Factor::stiffness, act * change.stiffness * sense},
                 {Factor::damping, act * change.damping * sense}};
      break;
    }
    default:
      break;
  }
}

Complex LinearOperation::factor(Shape::Factor of, double w) const {
  switch (of) {
    case Shape::Factor::inertia:
      return 1;
    case Shape::Factor::stiffness:
      return -1 / (w * w);
    case Shape::Factor::damping:
      return 1.0 / (kJ * w);
    case Shape::Factor::resonance:
      return transmissibility(effect_, w);
  }
  return 0;
}

void LinearOperation::add_to(double w, Eigen::MatrixXcd& operation) const {
  for (const Shape& shape : shapes_) {
    const Complex f = factor(shape.factor, w);
    operation.real() += f.real() * shape.of_axes;
    operation.imag() += f.imag() * shape.of_axes;
  }
}

void LinearOperation::add_times(const VectorXd& w, const Eigen::MatrixXcd& motion, bool adjoint,
                                Eigen::MatrixXcd& out) const {
  for (const Shape& shape : shapes_) {
    const MatrixXd matrix = adjoint ? MatrixXd(shape.of_axes.transpose()) : shape.of_axes;
    Eigen::MatrixXcd product(out.rows(), out.cols());
    product.real() = matrix * motion.real();
    product.imag() = matrix * motion.imag();
    for (Index b = 0; b < w.size(); ++b) {
      const Complex f = factor(shape.factor, w[b]);
      out.col(b) += (adjoint ? std::conj(f) : f) * product.col(b);
    }
  }
}

Eigen::MatrixXcd LinearOperation::at(double w) const {
  Eigen::MatrixXcd out = Eigen::MatrixXcd::Zero(rows_, cols_);
  add_to(w, out);
  return out;
}

}  // namespace framewatch::estimator
