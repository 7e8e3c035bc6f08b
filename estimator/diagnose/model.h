#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/law.h"
#include "estimator/diagnose/plant.h"
#include "estimator/structure/effect.h"

namespace framewatch {

/// How an internal parameter of an effect moves in a fit.
struct Knob {
  double value = 0;  ///< internal: the logarithm where `logarithmic`
  bool logarithmic = false;
  double step = 0;  ///< of a finite difference
  double low = -1e300, high = 1e300;
  double sigma = 0;  ///< weak prior around `centre`, 0: none
  double centre = 0;
  bool free = true;

  double plain() const;
};

/// One effect inside a model that is being fitted.
struct ModelEffect {
  LawForm form = LawForm::power;
  EffectPlace place;
  std::vector<Knob> knobs;                      ///< shared by the records, amplitude first
  std::vector<std::vector<Knob>> record_knobs;  ///< of each record
  double deformation = 1.0, rate = 1.0;         ///< scales, m and m/s
  std::vector<double> onset_s;                  ///< harmonic: of each record

  bool element_law() const { return is_element_law(form); }
  LawValues law(std::size_t record) const;
};

/// A model of building and instruments: what a fit changes.
struct Model {
  Eigen::VectorXd theta;
  Eigen::VectorXd mass_change;  ///< relative, per coordinate
  Eigen::VectorXd gain;         ///< relative error of every axis
  Eigen::VectorXd clock_s;      ///< delay of every axis
  std::vector<ModelEffect> effects;
  std::vector<int> free_gain, free_clock;  ///< axes whose error is an effect, not a tolerance
};

Model initial_model(const Plant& plant);

/// Index in theta of the element a frame or panel place names.
int element_of(const Plant& plant, const EffectPlace& place);

/// The frames that meet at a crossing; one of a plane building.
std::vector<int> frames_at(const Structure& structure, int crossing);

/// Coordinate a node names (flexible floors).
Eigen::VectorXd node_direction(const Plant& plant, int story, int frame);

}  // namespace framewatch
