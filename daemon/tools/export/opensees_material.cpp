// SPDX-License-Identifier: MIT
#include "daemon/tools/export/opensees_material.h"

#include <cmath>

#include <fmt/core.h>

namespace framewatch::daemon {
namespace {

using estimator::Effect;
using estimator::EffectKind;
using Materials = std::vector<OpenSeesMaterial>;

/// A force at which the springs of contacts yield, as a deformation: farther than any.
constexpr double kNeverYields_m = 1e3;

/// Returns c |d|^power with the sign of d.
OpenSeesMaterial power_material(double factor, double power, const MaterialScale& scale) {
  return {"ElasticPowerFunc",
          {"-coeff", opensees_number(factor * scale.force * std::pow(scale.stretch, power)), "-exp",
           opensees_number(power)}};
}

Materials spring_materials(const Effect& e, const char* key, double power,
                           const MaterialScale& scale, std::string& why) {
  if (e.value("saturation_m") > 0) {
    why = "OpenSees has no elastic material that saturates; without saturation_m it has one";
    return {};
  }
  return {power_material(e.value(key), power, scale)};
}

/// Returns a spring in series with a slider that yields at the deformation `yield`, 1 + asymmetry
/// times that toward positive and 1 - asymmetry times toward negative deformation.
OpenSeesMaterial slider_material(double stiffness, double yield, const MaterialScale& scale,
                                 double asymmetry = 0) {
  OpenSeesMaterial out{"ElasticPP",
                       {opensees_number(stiffness * scale.force * scale.stretch),
                        opensees_number((1 + asymmetry) * yield / scale.stretch)}};
  if (asymmetry != 0) {
    out.words.push_back(opensees_number(-(1 - asymmetry) * yield / scale.stretch));
    out.words.push_back("0.0");  // strain at rest
  }
  return out;
}

Materials bilinear_materials(const Effect& e, const MaterialScale& scale, std::string& why) {
  if (e.value("sharpness") > 0) {
    why =
        "no material of OpenSees yields as roundly by Masing's rule; without sharpness it has one";
    return {};
  }
  if (e.value("peak_oriented") > 0) {
    why =
        "no elastic-plastic material of OpenSees returns toward its largest deformation; without "
        "peak_oriented it has one";
    return {};
  }
  if (e.value("strength_loss") > 0) {
    why = "no material of OpenSees yields like it and loses strength by its work";
    return {};
  }
  const double kh = e.value("kh_npm"), dy = e.value("dy_m"), spread = e.value("spread");
  const double asymmetry = e.value("asymmetry");
  if (!(spread > 0)) return {slider_material(kh, dy, scale, asymmetry)};
  constexpr int kSprings = 10;  // as docs/effects.md says
  Materials out;
  for (int i = 0; i < kSprings; ++i)
    out.push_back(slider_material(kh / kSprings, dy * (1 + spread * ((2.0 * i + 1) / kSprings - 1)),
                                  scale, asymmetry));
  return out;
}

/// z of OpenSees is z over the stretch; its energy is in N*m per unit of strain.
OpenSeesMaterial bouc_wen_material(const Effect& e, const MaterialScale& scale) {
  const double kh = e.value("kh_npm") * scale.force * scale.stretch;
  const double dy = e.value("dy_m") / scale.stretch, n = e.value("exponent");
  const double at_yield = std::pow(dy, -n), work = kh * dy * dy;
  const double loss = work > 0 ? 1 / work : 0;
  return {"BoucWen",
          {"0.0", opensees_number(kh), opensees_number(n),
           opensees_number((e.value("loading") - e.value("beta")) * at_yield),
           opensees_number(e.value("beta") * at_yield), "1.0", "0.0",
           opensees_number(e.value("strength_loss") * loss),
           opensees_number(e.value("stiffness_loss") * loss)}};
}

Materials contact_materials(const Effect& e, const MaterialScale& scale, std::string& why) {
  if (e.value("cg_nspm") > 0) {
    why = "OpenSees has no gap with a dashpot that only pushes; without cg_nspm it has one";
    return {};
  }
  const double kg = e.value("kg_npm"), gap = e.value("gap_m");
  const bool both = e.kind == EffectKind::two_sided_gap;
  const bool up = both || e.value("side") > 0;
  Materials out;
  for (const int side : {1, -1})
    if (side > 0 ? up : both || !up)
      out.push_back({"ElasticPPGap",
                     {opensees_number(kg * scale.force * scale.stretch),
                      opensees_number(side * kg * scale.force * kNeverYields_m),
                      opensees_number(side * gap / scale.stretch)}});
  return out;
}

}  // namespace

std::string opensees_number(double value) {
  const std::string text = fmt::format("{:.17g}", value);
  return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

OpenSeesMaterial elastic_material(double stiffness, double damping, const MaterialScale& scale) {
  const double factor = scale.force * scale.stretch;
  return {"Elastic", {opensees_number(stiffness * factor), opensees_number(damping * factor)}};
}

std::vector<OpenSeesMaterial> opensees_materials(const Effect& e, double height_m,
                                                 const MaterialScale& scale, std::string& why) {
  switch (e.kind) {
    case EffectKind::cubic_stiffness:
      return spring_materials(e, "k3_npm3", 3, scale, why);
    case EffectKind::quadratic_stiffness:
      return spring_materials(e, "k2_npm2", 2, scale, why);
    case EffectKind::quadratic_damping:
      return {{"Viscous",
               {opensees_number(e.value("c2_ns2pm2") * scale.force * scale.stretch * scale.stretch),
                "2.0"}}};
    case EffectKind::p_delta:
      return {elastic_material(-e.value("weight_n") / height_m, 0, scale)};
    case EffectKind::added_spring:
      return {elastic_material(e.value("k_npm"), 0, scale)};
    case EffectKind::added_damper:
      return {elastic_material(0, e.value("c_nspm"), scale)};
    case EffectKind::bilinear_hysteresis:
      return bilinear_materials(e, scale, why);
    case EffectKind::bouc_wen:
      return {bouc_wen_material(e, scale)};
    case EffectKind::one_sided_gap:
    case EffectKind::two_sided_gap:
      return contact_materials(e, scale, why);
    case EffectKind::coulomb_friction:
      if (const double ks = e.value("stick_npm"); ks > 0)
        return {slider_material(ks, e.value("fc_n") / ks, scale)};
      why = "OpenSees has no friction that is smooth in velocity; with stick_npm it has ElasticPP";
      return {};
    default:
      why = "no material of OpenSees has its law";
      return {};
  }
}

}  // namespace framewatch::daemon
