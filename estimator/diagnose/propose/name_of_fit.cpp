#include "estimator/diagnose/propose/name_of_fit.h"

#include <algorithm>

namespace framewatch::estimator {

EffectKind name_of_fit(const ModelEffect& effect, const RecordSegment& segment) {
  switch (effect.form) {
    case LawForm::power:
      return effect.parameters[1].plain() < 2.45 ? EffectKind::quadratic_stiffness
                                                 : EffectKind::cubic_stiffness;
    case LawForm::hysteresis:
      if (effect.parameters[1].plain() < 0.02 * effect.deformation)
        return EffectKind::coulomb_friction;
      return effect.parameters[2].plain() > 20 ? EffectKind::bilinear_hysteresis
                                               : EffectKind::bouc_wen;
    case LawForm::pinched:
      return EffectKind::pinching;
    case LawForm::friction:
      return EffectKind::coulomb_friction;
    case LawForm::power_damping:
      return EffectKind::quadratic_damping;
    case LawForm::gap_positive:
    case LawForm::gap_negative:
      return EffectKind::one_sided_gap;
    case LawForm::gap_both:
      return EffectKind::two_sided_gap;
    case LawForm::changing: {
      // The length of a change shows only in records with motion while it goes on.
      double shortest = 1e300;
      for (const std::vector<LawParameter>& parameters : effect.record_parameters)
        shortest = std::min(shortest, parameters[1].plain());
      return shortest < 0.06 * segment.seconds() ? EffectKind::stiffness_drop
                                                 : EffectKind::stiffness_drift;
    }
    case LawForm::mass:
      return EffectKind::extra_mass;
    case LawForm::resonator:
      return EffectKind::tuned_mass_damper;
    case LawForm::spring:
      return EffectKind::added_spring;
    case LawForm::damper:
      return EffectKind::added_damper;
    case LawForm::rocking:
      return EffectKind::base_rocking;
    case LawForm::bending:
      return EffectKind::frame_bending;
    case LawForm::harmonic:
      return EffectKind::unmeasured_force;
    case LawForm::panels:
      return EffectKind::floor_flexibility;
    case LawForm::broadband:
      return EffectKind::unmeasured_force;
    case LawForm::clipped:
      return EffectKind::clipping;
    case LawForm::misaligned:
      return EffectKind::misalignment;
    case LawForm::swapped:
      break;
  }
  return EffectKind::swapped;
}

}  // namespace framewatch::estimator
