// SPDX-License-Identifier: MIT
#include "estimator/diagnose/trials/catalogue_form.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>

#include "estimator/diagnose/fit/normal_equations.h"
#include "estimator/diagnose/law/hysteretic_force.h"
#include "estimator/diagnose/law/law.h"
#include "estimator/diagnose/model/law_port.h"
#include "estimator/diagnose/propose/name_of_fit.h"
#include "estimator/numeric/solve.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kTailPower = 0.05;  ///< share of a force's power below its band, and above it

void set_axis_values(Effect& out, const Plant& plant, const Model& model) {
  const auto axis = static_cast<Eigen::Index>(out.place.channel);
  switch (out.kind) {
    case EffectKind::gain_error:
      out.set("gain", model.gain[axis]);
      break;
    case EffectKind::time_shift:
      out.set("shift_s",
              model.clock_s[axis] - plant.axes[static_cast<std::size_t>(out.place.channel)].delay);
      break;
    default:
      break;
  }
}

double clipping_level(const std::vector<RecordSegment>& segments, Eigen::Index axis) {
  double level = 1e300;
  for (const RecordSegment& s : segments)
    level = std::min(level, 0.5 * (s.accel.col(axis).maxCoeff() - s.accel.col(axis).minCoeff()));
  return level;
}

/// Sets size and band of an arbitrary force: the part of the first segment that no other effect
/// explains.
void set_broadband(Effect& out, const Plant& plant, const std::vector<RecordSegment>& segments,
                   const ModelEffect& e, const Model& model) {
  Model rest = model;
  std::erase_if(rest.effects, [&](const ModelEffect& other) {
    return other.form == LawForm::broadband && other.place == e.place;
  });
  const RecordSegment& s = segments.front();
  const Whitened system =
      whiten(plant, rest, s, 0, forcing_of(rest), {}, steps_per_sample(plant, s));
  if (!system.good) return;
  const Eigen::Index n = plant.equations();
  const Eigen::VectorXcd direction =
      node_direction(plant, e.place.story, e.place.frame).cast<std::complex<double>>();
  Eigen::VectorXd power(s.bins());
  for (Eigen::Index b = 0; b < s.bins(); ++b) {
    const Eigen::VectorXcd u = system.weights->whitener(b).times(direction);
    const Eigen::VectorXcd r = rows_of_bin(system.rest, b, n);
    const double weight = u.squaredNorm();
    power[b] = std::max(0.0, std::norm(u.dot(r) / weight) - 1 / weight);
  }
  const double total = power.sum(), intervals = static_cast<double>(s.intervals());
  double below = 0;
  double low = s.w[0], high = s.w[s.bins() - 1];
  for (Eigen::Index b = 0; b < s.bins(); ++b) {
    if (below < kTailPower * total) low = s.w[b];
    below += power[b];
    if (below < (1 - kTailPower) * total) high = s.w[b];
  }
  out.set("rms_n", std::sqrt(2 * total) / intervals);
  out.set("low_hz", low / (2 * M_PI));
  out.set("high_hz", std::max(high, 1.01 * low) / (2 * M_PI));
}

void set_hysteresis(const ModelEffect& e, Effect& out) {
  using H = HysteresisIndex;
  std::vector<double> p;
  for (const LawParameter& one : e.parameters) p.push_back(one.plain());
  out.set("kh_npm", p[H::kh]);
  out.set("dy_m", p[H::dy]);
  if (e.form == LawForm::sliders) {
    out.set("spread", std::max(p[SliderIndex::spread], 1e-3));
    out.set("strength_loss", value_or(p, SliderIndex::loss, 0));
    out.set("asymmetry", value_or(p, SliderIndex::asymmetry, 0));
  }
  if (e.form == LawForm::asymptotic) out.set("spread", spread_like(p[AsymptoteIndex::sharpness]));
  if (e.form == LawForm::masing) out.set("sharpness", p[MasingIndex::sharpness]);
  if (e.form == LawForm::peak_oriented) {
    out.set("peak_oriented", 1);
    out.set("unloading", p[PeakIndex::unloading]);
  }
  if (e.form == LawForm::slack) {
    out.set("slip_ratio", 0);
    out.set("slack", 1);
    out.set("play_m", p[SlackIndex::play]);
    return;
  }
  if (out.kind == EffectKind::bilinear_hysteresis) return;
  const bool plain = e.form == LawForm::hysteresis;
  out.set("exponent", p[H::exponent]);
  out.set("beta", p[H::beta]);
  out.set("strength_loss", value_or(p, plain ? +H::strength_loss : +H::pinched_strength, 0));
  out.set("stiffness_loss", value_or(p, plain ? +H::stiffness_loss : +H::pinched_stiffness, 0));
  if (plain) {
    out.set("loading", value_or(p, H::loading, 1));
    return;
  }
  out.set("slip_ratio", p[H::slip]);
  out.set("slip_width", p[H::width]);
  out.set("slip_offset", value_or(p, H::offset, 0));
  out.set("slip_work", value_or(p, H::slip_work, 0));
  out.set("slip_lock", e.form == LawForm::slip_lock ? 1.0 : 0.0);
}

void set_friction(const ModelEffect& e, Effect& out) {
  const auto p = [&](std::size_t i) { return e.parameters[i].plain(); };
  if (is_hysteretic(e.form)) {
    out.set("fc_n", p(0) * p(1));
    out.set("v0_mps", 1e-3 * e.rate);
    out.set("stick_npm", p(0));
    return;
  }
  out.set("fc_n", p(0));
  if (e.form == LawForm::power_damping) {
    out.set("v0_mps", 0.01 * e.rate);
    return;
  }
  out.set("v0_mps", p(1));
  if (e.parameters.size() < 4) return;
  out.set("static_ratio", p(2));
  out.set("stribeck_mps", p(3));
  if (e.parameters.size() > 4) out.set("presliding_m", p(4));
}

/// Returns the largest share of the deformation D at which a frame that loses `share` of its
/// stiffness at D loses no more than all. saturation: AmplitudeIndex.
double nearer_of(double share, double exponent, double saturation) {
  if (share <= 1 || exponent <= 1) return 1;
  const double shape = exponent - 1;
  if (!(saturation > 0)) return std::pow(share, -1 / shape);
  const double at_last = share / (1 - saturation * bent(1 / saturation, shape));
  return saturation * std::pow(std::pow(1 - 1 / at_last, -shape) - 1, 1 / shape);
}

/// At a deformation of a whole frame, as shares of the mean stiffness.
void set_amplitude(const Plant& plant, const Model& model, const ModelEffect& e, Effect& out) {
  double k = 0;
  const std::vector<LawPort> ports = law_ports(plant, model, e);
  for (const LawPort& port : ports)
    k += model.theta[port.element] / static_cast<double>(ports.size());
  const auto p = [&](std::size_t i) { return e.parameters[i].plain(); };
  const double share = -p(0) / (k * e.deformation), exponent = p(1);
  const bool saturates = e.parameters.size() > AmplitudeIndex::saturation;
  const double saturation = saturates ? p(AmplitudeIndex::saturation) : 0;
  // An element cannot lose more than all its stiffness, so a larger share becomes the same law at a
  // smaller deformation.
  const double nearer = nearer_of(share, exponent, saturation);
  out.set("softening", share * Softening(exponent, saturation).at(nearer) / nearer);
  out.set("at_m", nearer * e.deformation);
  out.set("exponent", exponent);
  out.set("damping_s2pm", p(2) / (k * e.rate * e.rate));
  if (e.parameters.size() > AmplitudeIndex::slip) out.set("slip", p(AmplitudeIndex::slip));
  if (saturates) out.set("saturation_m", saturation * e.deformation);
}

/// Sets a spring that is the power `p` of the deformation, or that far below its saturation.
void set_spring(const ModelEffect& fitted, const char* key, double p, Effect& out) {
  if (fitted.form == LawForm::power) {
    out.set(key, fitted.parameters[0].plain() / std::pow(fitted.deformation, p));
    return;
  }
  using S = SaturationIndex;
  const ModelEffect e = fitted.form == LawForm::saturating ? fitted : two_slopes(fitted);
  const double d0 = e.parameters[S::d0].plain(), shape = e.parameters[S::shape].plain();
  const double lost = e.deformation - d0 * bent(e.deformation / d0, shape);
  out.set(key, e.parameters[S::force].plain() / (lost * shape * std::pow(d0, p - 1)));
  out.set("saturation_m", d0);
  out.set("shape", shape);
}

/// Sets the values of effects of elements. Leaves other effects unchanged.
void set_element_values(const Plant& plant, const ModelEffect& e, Effect& out) {
  const auto p = [&](std::size_t i) { return e.parameters[i].plain(); };
  switch (out.kind) {
    case EffectKind::cubic_stiffness:
      set_spring(e, "k3_npm3", 3, out);
      break;
    case EffectKind::quadratic_stiffness:
      set_spring(e, "k2_npm2", 2, out);
      break;
    case EffectKind::bilinear_hysteresis:
    case EffectKind::bouc_wen:
    case EffectKind::pinching:
      set_hysteresis(e, out);
      break;
    case EffectKind::coulomb_friction:
      set_friction(e, out);
      break;
    case EffectKind::quadratic_damping:
      out.set("c2_ns2pm2", p(0) / (e.rate * e.rate));
      break;
    case EffectKind::one_sided_gap:
    case EffectKind::two_sided_gap:
      out.set("kg_npm", p(0));
      out.set("gap_m", p(1));
      if (e.parameters.size() > 2) out.set("cg_nspm", p(2));
      if (out.kind == EffectKind::one_sided_gap)
        out.set("side", e.form == LawForm::gap_positive ? 1.0 : -1.0);
      break;
    case EffectKind::stiffness_drop:
      out.set("dk_npm", p(0));
      out.set("at_s", std::max(0.0, e.record_parameters[0][0].plain()));
      break;
    case EffectKind::stiffness_drift:
      out.set("dk_npm", p(0));
      out.set("from_s", std::max(0.0, e.record_parameters[0][0].plain()));
      out.set("duration_s", e.record_parameters[0][1].plain());
      break;
    case EffectKind::p_delta:
      out.set("weight_n",
              -p(0) / e.deformation *
                  plant.structure.story_height[static_cast<std::size_t>(e.place.story - 1)]);
      break;
    default:
      break;
  }
}

/// Sets the values of linear effects that add mass, stiffness or damping. Leaves other effects
/// unchanged.
void set_linear_values(const ModelEffect& e, Effect& out) {
  const auto p = [&](std::size_t i) { return e.parameters[i].plain(); };
  switch (out.kind) {
    case EffectKind::extra_mass:
      out.set("mass_kg", p(0));
      break;
    case EffectKind::tuned_mass_damper:
      out.set("mass_kg", p(0));
      out.set("frequency_hz", p(1));
      out.set("damping_ratio", p(2));
      break;
    case EffectKind::base_rocking:
    case EffectKind::frame_bending:
      out.set("kr_nmprad", 1 / std::max(p(0), 1e-14));
      break;
    case EffectKind::added_spring:
      out.set("k_npm", p(0));
      break;
    case EffectKind::added_damper:
      out.set("c_nspm", p(0));
      break;
    case EffectKind::modal_damping:
      out.set("damping_ratio", p(0));
      break;
    case EffectKind::floor_flexibility:
      out.set("gk_nprad", p(0));
      out.set("gc_nsprad", p(1));
      break;
    default:
      break;
  }
}

void set_harmonic(const ModelEffect& e, Effect& out) {
  const double c = e.record_parameters[0][0].plain(), s = e.record_parameters[0][1].plain();
  out.set("amplitude_n", std::hypot(c, s));
  out.set("frequency_hz", e.parameters[0].plain());
  out.set("phase_rad", std::atan2(c, s));
  out.set("from_s", e.onset_s[0]);
}

}  // namespace

Eigen::VectorXd catalogue_values(const Plant& plant, const std::vector<RecordSegment>& segments,
                                 const FoundEffect& found, const Model& model) {
  const Effect effect = catalogue_effect(plant, segments, found, model);
  return Eigen::Map<const Eigen::VectorXd>(effect.values.data(),
                                           static_cast<Eigen::Index>(effect.values.size()));
}

Effect catalogue_effect(const Plant& plant, const std::vector<RecordSegment>& segments,
                        const FoundEffect& found, const Model& model) {
  Effect out = make_effect(found.chosen.kind, found.chosen.place);
  if (!found.ramp_mps3.empty()) {
    out.set("ramp_mps3", found.ramp_mps3.front());
    out.set("from_s", found.ramp_from_s.front());
    return out;
  }
  if (found.index < 0) {
    set_axis_values(out, plant, model);
    return out;
  }
  const ModelEffect& fitted = model.effects[static_cast<std::size_t>(found.index)];
  const bool slipless = fitted.form == LawForm::pinched && out.kind != EffectKind::pinching;
  const ModelEffect e = slipless ? without_slip(fitted) : fitted;
  switch (out.kind) {
    case EffectKind::unmeasured_force:
      if (e.form == LawForm::broadband)
        set_broadband(out, plant, segments, e, model);
      else
        set_harmonic(e, out);
      break;
    case EffectKind::clipping:
      out.set("level_mps2", clipping_level(segments, e.place.channel));
      break;
    case EffectKind::misalignment:
      out.set("angle_deg", e.parameters[0].plain() * 180 / M_PI);
      break;
    case EffectKind::amplitude_dependence:
      set_amplitude(plant, model, e, out);
      break;
    default:
      set_element_values(plant, e, out);
      set_linear_values(e, out);
      break;
  }
  return out;
}

void set_errors(const Fitter& fitter, const Model& model,
                const std::vector<Eigen::MatrixXcd>& motion, std::vector<FoundEffect>& effects) {
  if (effects.empty()) return;
  std::vector<Whitened> systems = fitter.systems(model, motion, forcing_of(model));
  if (systems.empty()) return;
  const Linearised at = fitter.linearise(model, std::move(systems), thorough(model, 0));
  MatrixXd normal = normal_equations(at, fitter.within()).normal;
  normal.diagonal() += at.prior;
  const VectorXd scale = normal.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  MatrixXd scaled = scale.asDiagonal() * normal * scale.asDiagonal();
  scaled.diagonal().array() += 1e-10;
  const Ldlt factor(scaled);
  for (FoundEffect& found : effects) {
    if (found.ramp_mps3.size() > 0) continue;
    const VectorXd value = catalogue_values(fitter.plant(), fitter.segments(), found, model);
    MatrixXd jacobian = MatrixXd::Zero(value.size(), normal.cols());
    for (std::size_t u = 0; u < at.unknowns.size(); ++u) {
      const Unknown& unknown = at.unknowns[u];
      const bool parameter = unknown.kind == Unknown::Kind::parameter ||
                             unknown.kind == Unknown::Kind::record_parameter;
      const bool axis = unknown.kind == Unknown::Kind::gain || unknown.kind == Unknown::Kind::clock;
      if (!(parameter && unknown.index == found.index) &&
          !(axis && found.index < 0 && unknown.index == found.chosen.place.channel))
        continue;
      constexpr double kPart = 0.05;  // of the unknown's unit, for the derivative
      Model moved = model;
      set_value(moved, unknown, value_of(model, unknown) + kPart);
      jacobian.col(static_cast<Index>(u)) =
          (catalogue_values(fitter.plant(), fitter.segments(), found, moved) - value) / kPart;
    }
    // Errors grow in proportion to the misfit over noise.
    const MatrixXd turned = scale.asDiagonal() * jacobian.transpose();
    const VectorXd variance =
        0.5 * at.level * (jacobian * (scale.asDiagonal() * factor.solve(turned))).diagonal();
    found.std_error.clear();
    for (const double v : variance) found.std_error.push_back(std::sqrt(std::max(v, 0.0)));
  }
}

}  // namespace framewatch::estimator
