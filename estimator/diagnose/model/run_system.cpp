// SPDX-License-Identifier: MIT
#include "estimator/diagnose/model/run_system.h"

#include <algorithm>
#include <complex>
#include <utility>

#include "estimator/diagnose/model/law_port.h"
#include "estimator/diagnose/model/linear_operation.h"
#include "estimator/diagnose/model/modal_damping.h"
#include "estimator/diagnose/spectra/fourier.h"
#include "estimator/numeric/solve.h"
#include "estimator/structure/matrices.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

bool are_same(const RunSystem& a, const RunSystem& b) {
  const auto same = [](const MatrixXd& x, const MatrixXd& y) {
    return x.rows() == y.rows() && x.cols() == y.cols() && x == y;
  };
  return same(a.stiffness, b.stiffness) && same(a.damping, b.damping) && same(a.mass, b.mass) &&
         same(a.inputs, b.inputs);
}

MatrixXd driving_signals(const VectorXd& errors, const RecordSegment& segment,
                         const std::vector<Index>& axes, int ratio) {
  const Index lead = segment.lead.rows(), samples = lead + segment.intervals();
  MatrixXd out(static_cast<Index>(axes.size()), samples * ratio);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto at = static_cast<Index>(i);
    VectorXd signal(samples);
    signal.head(lead) = segment.lead.col(axes[i]);
    signal.tail(segment.intervals()) = segment.accel.col(axes[i]).head(segment.intervals());
    signal /= 1 + errors[2 * at];
    out.row(at) = upsampled(signal, ratio, -errors[2 * at + 1] * segment.rate_hz).transpose();
  }
  return out;
}

constexpr double kMinMass_kg = 1e-9;  ///< of a resonator: its equation needs a mass

/// at: coordinate of the resonator's mass.
void add_resonator(const Plant& plant, const ModelEffect& e, Index at, RunSystem& out) {
  const double size = e.parameters[0].plain();
  const double wr = 2 * M_PI * e.parameters[1].plain(), h = e.parameters[2].plain();
  VectorXd b = VectorXd::Zero(out.mass.rows());
  b.head(plant.equations()) = node_direction(plant, e.place.story, e.place.frame);
  b[at] = -1;
  out.mass(at, at) = std::max(size, kMinMass_kg);
  out.stiffness += std::max(size, kMinMass_kg) * wr * wr * b * b.transpose();
  out.damping += std::max(size, kMinMass_kg) * 2 * h * wr * b * b.transpose();
}

void add_panels(const Plant& plant, const Model& model, const ModelEffect& e, RunSystem& out) {
  const Index n = plant.equations(), elements = plant.element_count();
  const MatrixXd& act = plant.building.act;
  const double size = e.parameters[0].plain();
  for (const Element& panel : plant.elements) {
    if (panel.panel < 0 || panel.story != e.place.story) continue;
    const Index at = panel.stiffness;
    out.stiffness.topLeftCorner(n, n) +=
        (size - model.theta[at]) * act.col(at) * act.col(at).transpose();
    out.damping.topLeftCorner(n, n) += (e.parameters[1].plain() - model.theta[at + elements]) *
                                       act.col(at) * act.col(at).transpose();
  }
}

/// Adds a rotation of the base or of the frames: constant matrices, taken from the operation at 1
/// rad/s.
void add_rotation(const Plant& plant, const Model& model, const ModelEffect& e, RunSystem& out) {
  const Index n = plant.equations();
  const Eigen::MatrixXcd change = LinearOperation(plant, model, e).at(1.0);
  const MatrixXd back = plant.motion.transpose() * inverse(plant.motion * plant.motion.transpose());
  out.stiffness.topLeftCorner(n, n) -= (change * back.cast<std::complex<double>>()).real();
  out.damping.topLeftCorner(n, n) -= (change * back.cast<std::complex<double>>()).imag();
}

/// Adds a linear effect without a separate coordinate.
void add_linear_effect(const Plant& plant, const Model& model, const ModelEffect& e,
                       RunSystem& out) {
  const Index n = plant.equations();
  const double size = e.parameters[0].plain();
  if (e.form == LawForm::mass) {
    for (const int frame : frames_at(plant.structure, e.place.crossing)) {
      const VectorXd at = node_direction(plant, e.place.story, frame);
      out.mass.topLeftCorner(n, n) += size * at * at.transpose();
    }
  } else if (e.form == LawForm::spring || e.form == LawForm::damper) {
    VectorXd at = node_direction(plant, e.place.story, e.place.frame);
    if (e.place.to_story > 0) at -= node_direction(plant, e.place.to_story, e.place.frame);
    (e.form == LawForm::spring ? out.stiffness : out.damping).topLeftCorner(n, n) +=
        size * at * at.transpose();
  } else if (e.form == LawForm::panels) {
    add_panels(plant, model, e, out);
  } else if (e.form == LawForm::rocking || e.form == LawForm::bending) {
    add_rotation(plant, model, e, out);
  }
}

/// Sets the inputs of the driving axes: inertia forces of the base's motion, or the measured force
/// itself.
void set_driving_inputs(const Plant& plant, const Model& model, const std::vector<Index>& driving,
                        RunSystem& out) {
  const Index n = plant.equations();
  const VectorXd frame_mass =
      assemble(plant.structure, plant.table, VectorXd::Zero(plant.table.size())).mass;
  for (std::size_t i = 0; i < driving.size(); ++i)
    out.inputs.col(static_cast<Index>(i)).head(n) =
        -plant.constraint.transpose() * frame_mass.cwiseProduct(plant.ground.col(driving[i]));
  for (std::size_t i = 0; i < driving.size(); ++i) {
    auto column = out.inputs.col(static_cast<Index>(i));
    column.head(n) = column.head(n).cwiseProduct((1 + model.mass_change.array()).matrix()) -
                     plant.push.col(driving[i]);
  }
  for (const ModelEffect& e : model.effects) {
    if (e.form != LawForm::mass) continue;
    for (std::size_t i = 0; i < driving.size(); ++i) {
      for (const int frame : frames_at(plant.structure, e.place.crossing)) {
        out.inputs.col(static_cast<Index>(i)).head(n) -=
            e.parameters[0].plain() * node_direction(plant, e.place.story, frame) *
            plant.ground(plant.structure.dof(e.place.story, frame), driving[i]);
      }
    }
  }
}

/// Sets the inertia forces of the resonators under the base's motion, and the inputs of the
/// effects' forces.
void set_effect_inputs(const Plant& plant, const Model& model, const std::vector<Index>& driving,
                       RunSystem& out) {
  const Index n = plant.equations();
  Index next = n;
  auto column = static_cast<Index>(driving.size());
  for (const ModelEffect& e : model.effects) {
    if (e.form == LawForm::resonator) {
      for (std::size_t i = 0; i < driving.size(); ++i)
        out.inputs(next, static_cast<Index>(i)) =
            -out.mass(next, next) *
            plant.ground(plant.structure.dof(e.place.story, e.place.frame), driving[i]);
      ++next;
    }
  }
  for (const ActiveLaw& active : active_laws(plant, model))
    out.inputs.col(column++).head(n) = -active.port.act;
  for (const ModelEffect& e : model.effects)
    if (e.form == LawForm::harmonic)
      out.inputs.col(column++).head(n) = node_direction(plant, e.place.story, e.place.frame);
}

}  // namespace

RunSystem run_system(const Plant& plant, const Model& model, const std::vector<Index>& driving) {
  const Index n = plant.equations();
  Index extra = 0, forces = 0;
  for (const ModelEffect& e : model.effects) {
    extra += e.form == LawForm::resonator;
    forces += e.form == LawForm::harmonic;
  }
  forces += static_cast<Index>(active_laws(plant, model).size());
  RunSystem out;
  out.mass = MatrixXd::Zero(n + extra, n + extra);
  out.mass.diagonal().head(n) = plant.mass.array() * (1 + model.mass_change.array());
  out.damping = MatrixXd::Zero(n + extra, n + extra);
  out.stiffness = out.damping;
  const MatrixXd& act = plant.building.act;
  const Index elements = plant.element_count();
  out.stiffness.topLeftCorner(n, n) =
      act * model.theta.head(elements).asDiagonal() * act.transpose();
  out.damping.topLeftCorner(n, n) = act * model.theta.tail(elements).asDiagonal() * act.transpose();
  out.damping.topLeftCorner(n, n) += modal_damping(plant, model);
  Index next = n;
  for (const ModelEffect& e : model.effects) {
    if (e.element_law() || e.form == LawForm::harmonic || e.parameters.empty()) continue;
    if (e.form == LawForm::resonator)
      add_resonator(plant, e, next++, out);
    else
      add_linear_effect(plant, model, e, out);
  }
  out.inputs = MatrixXd::Zero(n + extra, static_cast<Index>(driving.size()) + forces);
  set_driving_inputs(plant, model, driving, out);
  set_effect_inputs(plant, model, driving, out);
  return out;
}

const ModalSystem& RunCache::modes(const RunSystem& parts, double step_s) {
  if (!modes_ || modes_->step_s != step_s || !are_same(modes_->parts, parts)) {
    ++computed_;
    modes_ = Modes{parts, step_s,
                   ModalSystem(parts.mass, parts.damping, parts.stiffness, parts.inputs, step_s)};
  }
  return modes_->system;
}

const MatrixXd& RunCache::driving(const Model& model, const RecordSegment& segment,
                                  std::size_t record, const std::vector<Index>& axes, int ratio) {
  VectorXd errors(2 * static_cast<Index>(axes.size()));
  for (std::size_t i = 0; i < axes.size(); ++i)
    errors.segment(2 * static_cast<Index>(i), 2) << model.gain[axes[i]], model.clock_s[axes[i]];
  auto kept = driving_.find(record);
  if (kept == driving_.end() || kept->second.ratio != ratio || kept->second.errors != errors)
    kept = driving_
               .insert_or_assign(
                   record, Driving{errors, ratio, driving_signals(errors, segment, axes, ratio)})
               .first;
  return kept->second.signals;
}

}  // namespace framewatch::estimator
