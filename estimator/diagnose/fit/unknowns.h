// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <utility>
#include <vector>

#include "estimator/diagnose/model/model.h"

namespace framewatch::estimator {

/// Standard deviations of declared quantities that are not known exactly. 0: exact.
struct Tolerances {
  double mass = 0.01;        ///< relative, of the mass at every degree of freedom
  double gain = 0.005;       ///< relative, of every axis
  double clock_s = 0.25e-3;  ///< of every axis
};

/// One unknown of a fit: the member of the model, its unit, prior and bounds.
struct Unknown {
  enum class Kind { theta, mass, gain, clock, parameter, record_parameter } kind;
  int index = 0;      ///< of theta, coordinate or axis; for a parameter, of its effect
  int parameter = 0;  ///< of that effect
  int record = 0;
  double scale = 1;  ///< one unit of the unknown in the member
  double sigma = 0;  ///< of the prior, in units of the unknown; 0: no prior
  double center = 0;
  double low = -std::numeric_limits<double>::infinity();  ///< bounds, in units of the unknown
  double high = std::numeric_limits<double>::infinity();
  /// Further members of theta with the same value, and their scales.
  std::vector<std::pair<int, double>> tied = {};
  /// Longest step in one step of a fit, in units of the unknown: beyond it, the linearized
  /// equations are wrong.
  double longest_step = std::numeric_limits<double>::infinity();
  /// At its longest step it stops alone; otherwise the whole step is shortened. In a large building
  /// one element would hold up hundreds of others.
  bool stops_alone = false;
};

std::vector<Unknown> unknowns_of(const Plant& plant, const Model& model,
                                 const Tolerances& tolerances);
/// Returns true if the unknown is a mass, gain or clock within its tolerance, not an effect.
bool is_tolerated(const Unknown& unknown);
/// Returns the value in units of the unknown.
double value_of(const Model& model, const Unknown& unknown);
/// Sets the member, within the unknown's bounds.
void set_value(Model& model, const Unknown& unknown, double value);

}  // namespace framewatch::estimator
