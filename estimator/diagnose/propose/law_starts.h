// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "estimator/diagnose/model/model.h"
#include "estimator/structure/effect.h"

namespace framewatch::estimator {

/// Scales of a law's parameters.
struct LawScale {
  double stiffness = 1;    ///< of the element, N/m
  double deformation = 1;  ///< its largest, m
  double rate = 1;         ///< of the deformation, m/s

  double force() const { return stiffness * deformation; }
};

/// One family of laws with the shapes that a fit may start from. Amplitudes are 1, and a contact's
/// dashpot is that of a spring of 1 N/m.
struct LawStarts {
  LawForm form;
  EffectKind kind;  ///< first guess of the name
  std::vector<std::vector<LawParameter>> shapes;
};

/// Returns springs and dashpots without memory: powers, a saturating spring, friction, contacts.
std::vector<LawStarts> plain_starts(const LawScale& scale);
/// Returns contacts only.
std::vector<LawStarts> contact_starts(const LawScale& scale);
/// Returns hysteresis of every kind. pinching: include laws with slip zones.
std::vector<LawStarts> hysteretic_starts(const LawScale& scale, bool pinching);

/// Returns true if a start of an effect may have this amplitude: dissipative laws must not supply
/// energy.
bool has_amplitude(const ModelEffect& effect, double amplitude);
/// Sets the amplitude of a start, and the matching dashpot of a contact.
void set_amplitude(ModelEffect& effect, double amplitude);
/// Multiplies the amplitude of an effect, if it has one, within its bounds.
void scale_amplitude(double factor, ModelEffect& effect);

/// Frees the parameters that a first fit holds: exponents, unloading, losses, dashpots.
void free_shape(ModelEffect& effect);

}  // namespace framewatch::estimator
