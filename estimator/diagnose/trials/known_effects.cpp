// SPDX-License-Identifier: MIT
#include "estimator/diagnose/trials/known_effects.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "estimator/diagnose/law/hysteretic_force.h"
#include "estimator/diagnose/model/law_port.h"
#include "estimator/diagnose/model/modal_damping.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::VectorXcd;
using Eigen::VectorXd;

LawParameter sized(double value) {
  return linear_parameter(value, 0.02 * std::max(std::abs(value), 1e-12));
}

/// Sets the scales to the largest measured deformation and rate where a law acts.
void set_scales(const Plant& plant, const std::vector<RecordSegment>& segments, ModelEffect& e) {
  e.deformation = e.rate = 1e-12;
  for (const LawPort& port : law_ports(plant, initial_model(plant), e))
    for (const RecordSegment& s : segments) {
      const VectorXcd q = (port.sense.leftCols(plant.axis_count()) * s.spectrum).transpose();
      const VectorXcd d = -q.array() / s.w.array().square();
      const VectorXcd v = d.array() * s.w.array() * std::complex<double>(0, 1);
      e.deformation = std::max(e.deformation, signal_of(d, s, 1).cwiseAbs().maxCoeff());
      e.rate = std::max(e.rate, signal_of(v, s, 1).cwiseAbs().maxCoeff());
    }
}

/// Sets an error of an axis. Returns false if the effect is not an error of an axis.
bool add_axis_error(const Effect& effect, Model& model) {
  const int axis = effect.place.channel;
  switch (effect.kind) {
    case EffectKind::gain_error:
      model.gain[axis] += effect.value("gain");
      break;
    case EffectKind::polarity:
      model.gain[axis] -= 2;
      break;
    case EffectKind::time_shift:
      model.clock_s[axis] += effect.value("shift_s");
      model.free_clock.push_back(axis);
      return true;
    default:
      return false;
  }
  model.free_gain.push_back(axis);
  return true;
}

LawForm form_of(const Effect& effect) {
  using enum EffectKind;
  switch (effect.kind) {
    case cubic_stiffness:
    case quadratic_stiffness:
      return effect.value("saturation_m") > 0 ? LawForm::saturating : LawForm::power;
    case p_delta:
      return LawForm::power;
    case bilinear_hysteresis:
      if (effect.value("peak_oriented") > 0) return LawForm::peak_oriented;
      if (effect.value("sharpness") > 0) return LawForm::masing;
      return effect.value("spread") > 0 || effect.value("strength_loss") > 0 ||
                     effect.value("asymmetry") != 0
                 ? LawForm::sliders
                 : LawForm::hysteresis;
    case bouc_wen:
      return LawForm::hysteresis;
    case pinching:
      if (effect.value("slack") > 0) return LawForm::slack;
      return effect.value("slip_lock") > 0 ? LawForm::slip_lock : LawForm::pinched;
    case coulomb_friction:
      return effect.value("stick_npm") > 0 ? LawForm::hysteresis : LawForm::friction;
    case amplitude_dependence:
      return LawForm::amplitude;
    case quadratic_damping:
      return LawForm::power_damping;
    case one_sided_gap:
      return effect.value("side") > 0 ? LawForm::gap_positive : LawForm::gap_negative;
    case two_sided_gap:
      return LawForm::gap_both;
    case stiffness_drop:
    case stiffness_drift:
      return LawForm::changing;
    case extra_mass:
      return LawForm::mass;
    case tuned_mass_damper:
      return LawForm::resonator;
    case base_rocking:
      return LawForm::rocking;
    case frame_bending:
      return LawForm::bending;
    case added_spring:
      return LawForm::spring;
    case added_damper:
      return LawForm::damper;
    case modal_damping:
      return LawForm::modal_damping;
    case floor_flexibility:
      return LawForm::panels;
    case unmeasured_force:
      return effect.value("rms_n") > 0 ? LawForm::broadband : LawForm::harmonic;
    case clipping:
      return LawForm::clipped;
    case misalignment:
      return LawForm::misaligned;
    default:
      return LawForm::swapped;
  }
}

/// Sets a power law, or the negative stiffness of gravity (P-Delta).
void set_power(const Plant& plant, const Effect& effect, ModelEffect& e) {
  const double d = e.deformation;
  if (effect.kind == EffectKind::p_delta) {
    const double height = plant.structure.story_height[static_cast<std::size_t>(e.place.story - 1)];
    e.parameters = {fixed_parameter(-effect.value("weight_n") / height * d), fixed_parameter(1)};
    return;
  }
  const bool cubic = effect.kind == EffectKind::cubic_stiffness;
  const double p = cubic ? 3 : 2;
  e.parameters = {sized(effect.value(cubic ? "k3_npm3" : "k2_npm2") * std::pow(d, p)),
                  bounded_parameter(p, 0.02, 1.2, 9)};
}

void set_saturating(const Effect& effect, ModelEffect& e) {
  const bool cubic = effect.kind == EffectKind::cubic_stiffness;
  const double d = e.deformation, d0 = effect.value("saturation_m"), shape = effect.value("shape");
  const double first = effect.value(cubic ? "k3_npm3" : "k2_npm2") * std::pow(d0, cubic ? 2 : 1);
  e.parameters = {sized(first * shape * (d - d0 * bent(d / d0, shape))),
                  logarithmic_parameter(d0, 1e-4 * d, 1e3 * d),
                  logarithmic_parameter(shape, 0.1, 60)};
}

/// kh, dy, exponent, beta.
std::vector<LawParameter> hysteretic_shape(double kh, double dy, double exponent, double beta,
                                           double peak) {
  return {sized(kh), logarithmic_parameter(dy, 1e-4 * peak, 1e3 * peak),
          bounded_parameter(exponent, 0.05, 0.5, 60, false),
          bounded_parameter(beta, 0.02, 0.05, 10, false)};
}

void set_hysteresis(const Effect& effect, ModelEffect& e) {
  const auto value = [&](const char* key) { return effect.value(key); };
  const double d = e.deformation;
  const auto loss = [&](const char* key) {
    return bounded_parameter(value(key), 0.005, 0, 5, value(key) > 0);
  };
  if (effect.kind == EffectKind::coulomb_friction) {
    const double stick = value("stick_npm");
    e.parameters = hysteretic_shape(stick, value("fc_n") / stick, kBilinear, 0.5, d);
    return;
  }
  if (e.form == LawForm::sliders) {
    e.parameters = {
        sized(value("kh_npm")), logarithmic_parameter(value("dy_m"), 1e-4 * d, 1e3 * d),
        bounded_parameter(value("spread"), 0.02, 0, 0.98), loss("strength_loss"),
        bounded_parameter(value("asymmetry"), 0.02, -0.95, 0.95, value("asymmetry") != 0)};
    return;
  }
  const bool bilinear = effect.kind == EffectKind::bilinear_hysteresis;
  e.parameters =
      hysteretic_shape(value("kh_npm"), value("dy_m"), bilinear ? kBilinear : value("exponent"),
                       bilinear ? 0.5 : value("beta"), d);
  if (bilinear) return;
  if (effect.kind == EffectKind::pinching) {
    e.parameters.push_back(bounded_parameter(value("slip_ratio"), 0.02, 0.0, 0.99));
    e.parameters.push_back(logarithmic_parameter(value("slip_width"), 0.05, 50));
    e.parameters.push_back(fixed_parameter(value("slip_offset")));
    const double work = value("slip_work");
    e.parameters.push_back(work > 0 ? logarithmic_parameter(work, 0.05, 1e6) : fixed_parameter(0));
  }
  e.parameters.push_back(loss("strength_loss"));
  e.parameters.push_back(loss("stiffness_loss"));
  if (effect.kind == EffectKind::bouc_wen)
    e.parameters.push_back(fixed_parameter(value("loading")));
}

void set_amplitude(const Plant& plant, const Effect& effect, ModelEffect& e) {
  double k = 0;  // mean of the elements: LawPort::scale is 1 there
  int count = 0;
  for (const Element& element : plant.elements) {
    const bool own =
        element.frame >= 0 && (e.place.kind == PlaceKind::whole_frame
                                   ? element.frame == e.place.frame
                                   : plant.structure.direction(element.frame) == e.place.direction);
    k += own ? plant.design[element.stiffness] : 0;
    count += own;
  }
  k /= std::max(count, 1);
  e.deformation = effect.value("at_m");
  e.parameters = {sized(-effect.value("softening") * k * e.deformation),
                  fixed_parameter(effect.value("exponent")),
                  sized(effect.value("damping_s2pm") * k * e.rate * e.rate), fixed_parameter(2)};
  const double slip = effect.value("slip"), saturation = effect.value("saturation_m");
  if (slip > 0 || saturation > 0) e.parameters.push_back(fixed_parameter(slip));
  if (saturation > 0)
    e.parameters.push_back(logarithmic_parameter(saturation / e.deformation, 1e-4, 1e3));
}

void set_changing(const std::vector<RecordSegment>& segments, const Effect& effect,
                  ModelEffect& e) {
  const bool drop = effect.kind == EffectKind::stiffness_drop;
  e.parameters = {sized(effect.value("dk_npm"))};
  for (const RecordSegment& s : segments) {
    const double seconds = s.seconds();
    e.record_parameters.push_back(
        {bounded_parameter(std::min(effect.value(drop ? "at_s" : "from_s"), seconds), 0.1,
                           -0.2 * seconds, seconds),
         logarithmic_parameter(drop ? 0.05 : effect.value("duration_s"), 0.02, 2 * seconds)});
    e.record_parameters.back()[1].free = !drop;
  }
}

void set_harmonic(const std::vector<RecordSegment>& segments, const Effect& effect,
                  ModelEffect& e) {
  const double a = effect.value("amplitude_n"), p = effect.value("phase_rad");
  e.parameters = {
      bounded_parameter(effect.value("frequency_hz"), 0.02 / segments[0].seconds(), 1e-3, 1e3)};
  for (std::size_t r = 0; r < segments.size(); ++r) {
    const double step = 0.05 * std::max(a, 1e-9);
    e.record_parameters.push_back(
        {linear_parameter(a * std::sin(p), step), linear_parameter(a * std::cos(p), step)});
    e.onset_s.push_back(effect.value("from_s"));
  }
}

/// Sets the parameters of element laws. Leaves other effects unchanged.
void set_element_parameters(const Plant& plant, const std::vector<RecordSegment>& segments,
                            const Effect& effect, ModelEffect& e) {
  const auto value = [&](const char* key) { return effect.value(key); };
  const double d = e.deformation, v = e.rate;
  switch (e.form) {
    case LawForm::power:
      set_power(plant, effect, e);
      break;
    case LawForm::saturating:
      set_saturating(effect, e);
      break;
    case LawForm::hysteresis:
    case LawForm::sliders:
    case LawForm::pinched:
    case LawForm::slip_lock:
      set_hysteresis(effect, e);
      break;
    case LawForm::masing:
      e.parameters = {sized(value("kh_npm")),
                      logarithmic_parameter(value("dy_m"), 1e-4 * d, 1e3 * d),
                      logarithmic_parameter(value("sharpness"), 0.1, 60)};
      break;
    case LawForm::peak_oriented:
      e.parameters = {sized(value("kh_npm")),
                      logarithmic_parameter(value("dy_m"), 1e-4 * d, 1e3 * d),
                      bounded_parameter(value("unloading"), 0.02, 0, 1, value("unloading") > 0)};
      break;
    case LawForm::slack:
      e.parameters = {sized(value("kh_npm")),
                      logarithmic_parameter(value("dy_m"), 1e-4 * d, 1e3 * d),
                      bounded_parameter(value("play_m"), 0.005 * d, 0, d, value("play_m") > 0)};
      break;
    case LawForm::friction:
      e.parameters = {
          sized(value("fc_n")), logarithmic_parameter(value("v0_mps"), 1e-4 * v, 10 * v),
          bounded_parameter(value("static_ratio"), 0.02, -0.9, 10, value("static_ratio") != 0),
          fixed_parameter(value("stribeck_mps")),
          bounded_parameter(value("presliding_m"), 0.005 * d, 0, 0.3 * d,
                            value("presliding_m") > 0)};
      break;
    case LawForm::amplitude:
      set_amplitude(plant, effect, e);
      break;
    case LawForm::power_damping:
      e.parameters = {sized(value("c2_ns2pm2") * v * v), bounded_parameter(2, 0.02, 0.15, 5)};
      break;
    case LawForm::gap_positive:
    case LawForm::gap_negative:
    case LawForm::gap_both:
      e.parameters = {sized(value("kg_npm")),
                      logarithmic_parameter(std::max(value("gap_m"), 1e-3 * d), 1e-3 * d, 10 * d),
                      bounded_parameter(value("cg_nspm"), 0.05 * std::max(value("cg_nspm"), 1e-9),
                                        0, 1e15, value("cg_nspm") > 0)};
      break;
    case LawForm::changing:
      set_changing(segments, effect, e);
      break;
    default:
      break;
  }
}

/// Sets the parameters of all other effects of a model.
void set_other_parameters(const std::vector<RecordSegment>& segments, const Effect& effect,
                          ModelEffect& e) {
  const auto value = [&](const char* key) { return effect.value(key); };
  switch (e.form) {
    case LawForm::mass:
      e.parameters = {sized(value("mass_kg"))};
      break;
    case LawForm::resonator:
      e.parameters = {bounded_parameter(value("mass_kg"), 0.02 * value("mass_kg"), 1e-9, 1e15),
                      logarithmic_parameter(value("frequency_hz"), 1e-3, 1e3),
                      logarithmic_parameter(std::max(value("damping_ratio"), 1e-3), 1e-3, 2)};
      break;
    case LawForm::rocking:
    case LawForm::bending: {
      const double flexibility = 1 / value("kr_nmprad");
      e.parameters = {bounded_parameter(flexibility, 0.05 * flexibility, 0, 1e15)};
      break;
    }
    case LawForm::spring:
      e.parameters = {sized(value("k_npm"))};
      break;
    case LawForm::damper:
      e.parameters = {bounded_parameter(value("c_nspm"), 0.02 * value("c_nspm"), 0, 1e15)};
      break;
    case LawForm::modal_damping:
      e.parameters = {modal_ratio(value("damping_ratio"))};
      break;
    case LawForm::panels:
      e.parameters = {logarithmic_parameter(value("gk_nprad"), 1e-3 * value("gk_nprad"),
                                            1e3 * value("gk_nprad")),
                      bounded_parameter(value("gc_nsprad"), 1e-4 * value("gk_nprad"), 0, 1e15)};
      break;
    case LawForm::harmonic:
      set_harmonic(segments, effect, e);
      break;
    case LawForm::misaligned:
      e.parameters = {bounded_parameter(value("angle_deg") * M_PI / 180, 1e-3, -1.5, 1.5)};
      break;
    default:
      break;
  }
}

}  // namespace

std::vector<FoundEffect> add_known(const Plant& plant, const std::vector<RecordSegment>& segments,
                                   const std::vector<Effect>& effects, Model& model) {
  std::vector<FoundEffect> out;
  for (const Effect& effect : effects) {
    FoundEffect known;
    known.chosen.kind = effect.kind;
    known.chosen.place = effect.place;
    known.confidence = 1;
    if (effect.kind == EffectKind::bias_drift) {
      known.ramp_mps3.assign(segments.size(), effect.value("ramp_mps3"));
      known.ramp_from_s.assign(segments.size(), effect.value("from_s"));
    } else if (!add_axis_error(effect, model)) {
      ModelEffect e;
      e.form = form_of(effect);
      e.place = effect.place;
      if (e.element_law()) {
        set_scales(plant, segments, e);
        set_element_parameters(plant, segments, effect, e);
      } else {
        set_other_parameters(segments, effect, e);
      }
      known.index = static_cast<int>(model.effects.size());
      model.effects.push_back(std::move(e));
    }
    out.push_back(std::move(known));
  }
  return out;
}

}  // namespace framewatch::estimator
