#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/law/law.h"
#include "estimator/diagnose/law/law_parameter.h"
#include "estimator/diagnose/model/plant.h"
#include "estimator/structure/effect.h"

namespace framewatch::estimator {

/// One effect inside a model that is being fitted.
struct ModelEffect {
  LawForm form = LawForm::power;
  EffectPlace place;
  std::vector<LawParameter> parameters;  ///< shared by the records, amplitude first
  /// Parameters that every record has its own of, in the order of the records.
  std::vector<std::vector<LawParameter>> record_parameters;
  double deformation = 1.0, rate = 1.0;  ///< scales of the law, m and m/s
  std::vector<double> onset_s;           ///< harmonic force: when it begins in each record

  bool element_law() const { return is_element_law(form); }
  /// The law's values in one record.
  LawValues law(std::size_t record) const;
};

/// A model of the building and its instruments: everything that a fit changes.
struct Model {
  Eigen::VectorXd theta;        ///< stiffnesses, then dampings, theta order
  Eigen::VectorXd mass_change;  ///< relative, per coordinate
  Eigen::VectorXd gain;         ///< relative error of every axis
  Eigen::VectorXd clock_s;      ///< delay of every axis
  std::vector<ModelEffect> effects;
  /// Axes whose gain or delay is an effect, not a tolerance: they have no prior.
  std::vector<int> free_gain, free_clock;
};

/// The design without effects but the bending of its frames, masses and gains as declared, delays
/// as configured.
Model initial_model(const Plant& plant);

/// Index in theta of the stiffness that a frame or panel place names.
int element_of(const Plant& plant, const EffectPlace& place);

/// The frames that meet at a crossing; the only one in a plane building.
std::vector<int> frames_at(const Structure& structure, int crossing);

/// Direction of a force on one frame at one floor: a unit vector over the coordinates where floors
/// are flexible.
Eigen::VectorXd node_direction(const Plant& plant, int story, int frame);

}  // namespace framewatch::estimator
