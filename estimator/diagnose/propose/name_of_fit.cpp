// SPDX-License-Identifier: MIT
#include "estimator/diagnose/propose/name_of_fit.h"

#include <algorithm>
#include <cmath>

#include "estimator/diagnose/law/hysteretic_force.h"
#include "estimator/numeric/solve.h"

namespace framewatch::estimator {

namespace {

EffectKind elastic_name(const SearchSettings& settings, double exponent) {
  return exponent < settings.quadratic ? EffectKind::quadratic_stiffness
                                       : EffectKind::cubic_stiffness;
}

/// Returns true if a pinched law is clearly softer at zero force than where it yields.
bool slips(const ModelEffect& effect, double most) {
  using H = HysteresisIndex;
  const auto p = [&](std::size_t i) { return effect.parameters[i].plain(); };
  const auto stiffness = [&](double z) {
    return 1 - p(H::slip) * std::exp(-std::pow((z - p(H::offset)) / p(H::width), 2));
  };
  return p(H::slip_work) > 0 || stiffness(1) > most * stiffness(0);
}

}  // namespace

double nearest_exponent(const ModelEffect& effect) {
  constexpr int kPoints = 200;
  Eigen::VectorXd d(kPoints);
  for (int i = 0; i < kPoints; ++i)
    d[i] = effect.deformation * std::sin(M_PI * (i + 0.5) / kPoints - M_PI / 2);
  const Eigen::VectorXd force = law_force(effect.law(0), d, Eigen::VectorXd::Zero(kPoints), 1);
  double least = 1e300, out = 2;
  for (double p = 1.2; p < 9; p *= 1.05) {
    LawValues power{LawForm::power, {1, p}, effect.deformation, 1, 1};
    Eigen::MatrixXd columns(kPoints, 2);
    columns.col(0) = d;
    columns.col(1) = law_force(power, d, Eigen::VectorXd::Zero(kPoints), 1);
    const double rest = (force - columns * LeastSquares(columns).solve(force)).squaredNorm();
    if (rest >= least) continue;
    least = rest;
    out = p;
  }
  return out;
}

ModelEffect without_slip(const ModelEffect& pinched) {
  using H = HysteresisIndex;
  ModelEffect out = pinched;
  out.form = LawForm::hysteresis;
  const double left = 1 - pinched.parameters[H::slip].plain();
  LawParameter &kh = out.parameters[H::kh], &dy = out.parameters[H::dy];
  kh.value *= left;
  dy.value = dy.logarithmic ? dy.value - std::log(left) : dy.value / left;
  out.parameters.erase(out.parameters.begin() + H::slip, out.parameters.begin() + H::slip_work + 1);
  return out;
}

ModelEffect two_slopes(const ModelEffect& contact) {
  constexpr double kCorner = 20;  // shape
  const double stiffness = contact.parameters[0].plain(), d = contact.deformation;
  const double gap = std::max(contact.parameters[1].plain(), 1e-3 * d);
  const double force = stiffness * (d - gap * bent(d / gap, kCorner));
  ModelEffect out = contact;
  out.form = LawForm::saturating;
  out.parameters = {linear_parameter(force, 0.02 * std::abs(force)),
                    logarithmic_parameter(gap, 1e-3 * d, 5 * d),
                    logarithmic_parameter(kCorner, 0.3, 30)};
  return out;
}

EffectKind name_of_fit(const SearchSettings& settings, const ModelEffect& effect,
                       const RecordSegment& segment) {
  switch (effect.form) {
    case LawForm::power:
      return elastic_name(settings, effect.parameters[1].plain());
    case LawForm::saturating:
      return elastic_name(settings, nearest_exponent(effect));
    case LawForm::hysteresis:
      if (effect.parameters[1].plain() < settings.rigid * effect.deformation)
        return EffectKind::coulomb_friction;
      return effect.parameters[2].plain() > kSharpCorner ? EffectKind::bilinear_hysteresis
                                                         : EffectKind::bouc_wen;
    case LawForm::sliders:
    case LawForm::asymptotic:
    case LawForm::masing:
    case LawForm::peak_oriented:
      return effect.parameters[1].plain() < settings.rigid * effect.deformation
                 ? EffectKind::coulomb_friction
                 : EffectKind::bilinear_hysteresis;
    case LawForm::pinched:
      return slips(effect, settings.slips) ? EffectKind::pinching
                                           : name_of_fit(settings, without_slip(effect), segment);
    case LawForm::slip_lock:
    case LawForm::slack:
      return EffectKind::pinching;
    case LawForm::friction:
      return EffectKind::coulomb_friction;
    case LawForm::power_damping:
      return effect.parameters[1].plain() < settings.no_power ? EffectKind::coulomb_friction
                                                              : EffectKind::quadratic_damping;
    case LawForm::amplitude:
      return EffectKind::amplitude_dependence;
    case LawForm::gap_positive:
    case LawForm::gap_negative:
      return EffectKind::one_sided_gap;
    case LawForm::gap_both:
      return effect.parameters[0].plain() < 0 ? elastic_name(settings, nearest_exponent(effect))
                                              : EffectKind::two_sided_gap;
    case LawForm::changing: {
      // The length of a change shows only in records with motion during the change.
      double shortest = 1e300;
      for (const std::vector<LawParameter>& parameters : effect.record_parameters)
        shortest = std::min(shortest, parameters[1].plain());
      return shortest < settings.sudden * segment.seconds() ? EffectKind::stiffness_drop
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
    case LawForm::modal_damping:
      return EffectKind::modal_damping;
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
