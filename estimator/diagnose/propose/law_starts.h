#pragma once

#include <vector>

#include "estimator/diagnose/model/model.h"
#include "estimator/structure/effect.h"

namespace framewatch::estimator {

/// What the sizes of a law are measured in.
struct LawScale {
  double stiffness = 1;    ///< of the element, N/m
  double deformation = 1;  ///< its largest, m
  double rate = 1;         ///< of the deformation, m/s

  double force() const { return stiffness * deformation; }
};

/// One family of laws with the shapes from which a fit may start; amplitudes are 1, and a contact's
/// dashpot is that of a spring of 1 N/m.
struct LawStarts {
  LawForm form;
  EffectKind kind;  ///< first guess of the name
  std::vector<std::vector<LawParameter>> shapes;
};

/// Springs and dashpots without memory: powers, a spring that saturates, friction, contacts.
std::vector<LawStarts> plain_starts(const LawScale& scale);
/// Contacts alone.
std::vector<LawStarts> contact_starts(const LawScale& scale);
/// Hysteresis of every kind. pinching: also with slip zones.
std::vector<LawStarts> hysteretic_starts(const LawScale& scale, bool pinching);

/// Whether a start of an effect may have an amplitude: what damps does not drive.
bool has_amplitude(const ModelEffect& effect, double amplitude);
/// Gives a start its amplitude, and a contact the dashpot that belongs to it.
void set_amplitude(ModelEffect& effect, double amplitude);
/// Multiplies the amplitude that an effect has, if it has one, within its bounds.
void scale_amplitude(double factor, ModelEffect& effect);

/// Frees the parameters that a first fit holds: exponents, unloading, losses, dashpots.
void free_shape(ModelEffect& effect);

}  // namespace framewatch::estimator
