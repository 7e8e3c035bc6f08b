// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/law/law.h"
#include "estimator/diagnose/law/law_parameter.h"
#include "estimator/diagnose/model/plant.h"
#include "estimator/structure/effect.h"

namespace framewatch::estimator {

/// One effect of a model that is being fitted.
struct ModelEffect {
  LawForm form = LawForm::power;
  EffectPlace place;
  std::vector<LawParameter> parameters;  ///< shared by the records, amplitude first
  /// Parameters with a separate value in every record, in the order of the records.
  std::vector<std::vector<LawParameter>> record_parameters;
  double deformation = 1.0, rate = 1.0;  ///< scales of the law, m and m/s
  std::vector<double> onset_s;           ///< harmonic force: when it begins in each record

  bool element_law() const { return is_element_law(form); }
  /// Returns the law's values in one record.
  LawValues law(std::size_t record) const;
};

/// Model of a building and its instruments: everything that a fit changes.
struct Model {
  Eigen::VectorXd theta;        ///< stiffnesses, then dampings, theta order
  Eigen::VectorXd mass_change;  ///< relative, per coordinate
  Eigen::VectorXd gain;         ///< relative error of every axis
  Eigen::VectorXd clock_s;      ///< delay of every axis
  std::vector<ModelEffect> effects;
  /// Axes whose gain or delay is an effect instead of a tolerance. They have no prior.
  std::vector<int> free_gain, free_clock;
};

/// Returns true if the model has an effect that is an element law.
bool has_element_law(const Model& model);

/// Returns the design with declared masses and gains and configured delays. Its only effects are
/// the design's bending frames.
Model initial_model(const Plant& plant);

/// Returns the index in theta of the stiffness at a frame or panel place.
int element_of(const Plant& plant, const EffectPlace& place);

/// Returns the frames that meet at a crossing; a plane building has one.
std::vector<int> frames_at(const Structure& structure, int crossing);

/// Returns the direction of a force on one frame at one floor: a unit vector over the coordinates
/// if floors are flexible.
Eigen::VectorXd node_direction(const Plant& plant, int story, int frame);

/// Returns the moments of rotations per force of the elements: rotations x elements, m. The
/// rotations are of the base (LawForm::rocking), or of every floor of every frame (bending). For
/// bending, each row is scaled by the root of that rotation's flexibility over the one at the base,
/// if the design has bending.
Eigen::MatrixXd hinges(const Plant& plant, const ModelEffect& effect);

/// Change of the elements' stiffness and damping by rotations: elements x elements, to be added to
/// the diagonal matrices.
struct HingedElements {
  Eigen::MatrixXd stiffness, damping;
};
HingedElements hinged_elements(const Plant& plant, const Model& model, const ModelEffect& effect);

}  // namespace framewatch::estimator
