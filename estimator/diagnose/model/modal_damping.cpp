// SPDX-License-Identifier: MIT
#include "estimator/diagnose/model/modal_damping.h"

#include <algorithm>
#include <optional>

#include "estimator/diagnose/model/model.h"
#include "estimator/numeric/eigenvalues.h"
#include "estimator/structure/matrices.h"

namespace framewatch::estimator {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

MatrixXd damping_of(const ModelModes& modes, const ModelEffect& effect) {
  const Eigen::Index at = effect.place.mode - 1;
  const VectorXd along = modes.mass.cwiseProduct(modes.shapes.col(at));
  return 2 * effect.parameters[0].plain() * modes.w[at] * along * along.transpose();
}

bool acts(const ModelEffect& e) {
  return e.form == LawForm::modal_damping && e.parameters[0].plain() != 0;
}

}  // namespace

ModelModes modes_of(const Plant& plant, const Model& model) {
  const MatrixXd& act = plant.building.act;
  MatrixXd of_elements = model.theta.head(plant.element_count()).asDiagonal();
  for (const ModelEffect& e : model.effects)
    if (e.form == LawForm::rocking || e.form == LawForm::bending)
      of_elements += hinged_elements(plant, model, e).stiffness;
  ModelModes out;
  out.mass = plant.mass.array() * (1 + model.mass_change.array());
  const VectorXd root = out.mass.cwiseSqrt();
  const MatrixXd scaled = root.cwiseInverse().asDiagonal() * act;
  const RealEigen eigen = symmetric_eigen(scaled * of_elements * scaled.transpose());
  out.w = eigen.values.cwiseMax(0).cwiseSqrt();
  out.shapes = root.cwiseInverse().asDiagonal() * eigen.vectors;
  return out;
}

MatrixXd modal_damping(const Plant& plant, const Model& model, const ModelEffect& effect) {
  return damping_of(modes_of(plant, model), effect);
}

MatrixXd modal_damping(const Plant& plant, const Model& model) {
  MatrixXd out = MatrixXd::Zero(plant.equations(), plant.equations());
  std::optional<ModelModes> modes;
  for (const ModelEffect& e : model.effects) {
    if (!acts(e)) continue;
    if (!modes) modes = modes_of(plant, model);
    out += damping_of(*modes, e);
  }
  return out;
}

bool has_modal_damping(const Model& model) {
  return std::any_of(model.effects.begin(), model.effects.end(), acts);
}

std::vector<std::size_t> modes_in_band(const Plant& plant, const Model& model,
                                       const std::vector<RecordSegment>& records) {
  std::vector<std::size_t> out;
  std::optional<ModelModes> modes;
  for (std::size_t e = 0; e < model.effects.size(); ++e) {
    if (model.effects[e].form != LawForm::modal_damping) continue;
    if (!modes) modes = modes_of(plant, model);
    const double w = modes->w[model.effects[e].place.mode - 1];
    if (std::all_of(records.begin(), records.end(),
                    [w](const RecordSegment& s) { return w > s.w[0] && w < s.w[s.bins() - 1]; }))
      out.push_back(e);
  }
  return out;
}

MatrixXd relative_motion(const Plant& plant) {
  const Structure& s = plant.structure;
  const VectorXd mass = frame_masses(s);
  const MatrixXd of_ground = plant.constraint.transpose() * mass.asDiagonal() * plant.ground;
  return plant.motion - plant.mass.cwiseInverse().asDiagonal() * of_ground;
}

LawParameter modal_ratio(double value) {
  constexpr double kStep = 2e-3, kLargest = 2;
  return bounded_parameter(value, kStep, 0, kLargest);
}

}  // namespace framewatch::estimator
