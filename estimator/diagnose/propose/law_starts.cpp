// SPDX-License-Identifier: MIT
#include "estimator/diagnose/propose/law_starts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/diagnose/law/hysteretic_force.h"
#include "estimator/diagnose/law/law.h"

namespace framewatch::estimator {
namespace {

using F = LawForm;
using Shape = std::vector<LawParameter>;

constexpr double kMaxLoss = 5;

std::vector<double> shrinking(double from, double to, double factor) {
  std::vector<double> out;
  for (double x = from; x > to; x *= factor) out.push_back(x);
  return out;
}

LawParameter held(double value, double step, double low, double high) {
  return bounded_parameter(value, step, low, high, false);
}

/// kh, dy, exponent, beta.
Shape hysteretic(const LawScale& s, double yield, double exponent, double beta) {
  return {linear_parameter(1, 0.01 * s.stiffness),
          logarithmic_parameter(yield * s.deformation, 1e-4 * s.deformation, 5 * s.deformation),
          held(exponent, 0.05, 0.5, 60), held(beta, 0.02, 0.05, 10)};
}

void add_losses(Shape& shape) {
  for (int i = 0; i < 2; ++i) shape.push_back(held(0, 0.005, 0, kMaxLoss));
}

LawStarts bouc_wen(const LawScale& s, double exponent) {
  const bool bilinear = exponent > kSharpCorner;
  LawStarts out{
      F::hysteresis, bilinear ? EffectKind::bilinear_hysteresis : EffectKind::bouc_wen, {}};
  for (const double yield : shrinking(0.9, 0.004, 0.7)) {
    out.shapes.push_back(hysteretic(s, yield, exponent, 0.5));
    add_losses(out.shapes.back());
  }
  return out;
}

/// Returns smooth hysteresis that loses strength and stiffness with work.
LawStarts degrading(const LawScale& s) {
  LawStarts out{F::hysteresis, EffectKind::bouc_wen, {}};
  for (const double exponent : {1.0, 2.0})
    for (const double loss : {0.02, 0.1})
      for (const double yield : shrinking(0.8, 0.04, 0.65)) {
        out.shapes.push_back(hysteretic(s, yield, exponent, 0.5));
        add_losses(out.shapes.back());
        for (const std::size_t i :
             {+HysteresisIndex::strength_loss, +HysteresisIndex::stiffness_loss}) {
          out.shapes.back()[i].value = loss;
          out.shapes.back()[i].free = true;
        }
      }
  return out;
}

/// Returns hysteresis that hardens: z has no limit.
LawStarts hardening(const LawScale& s) {
  LawStarts out{F::hysteresis, EffectKind::bouc_wen, {}};
  for (const double yield : {0.25, 0.7, 2.0, 4.5}) {
    out.shapes.push_back(hysteretic(s, yield, 1, 2));
    add_losses(out.shapes.back());
    out.shapes.back().push_back(held(-1, 1, -1, 1));
  }
  return out;
}

LawStarts sliders(const LawScale& s) {
  LawStarts out{F::sliders, EffectKind::bilinear_hysteresis, {}};
  struct Start {
    double spread, asymmetry;
  };
  for (const Start& start : {Start{0.4, 0}, Start{0.9, 0}, Start{0.1, 0.5}, Start{0.1, -0.5}})
    for (const double yield : shrinking(1.5, 0.01, 0.62))
      out.shapes.push_back(
          {linear_parameter(1, 0.01 * s.stiffness),
           logarithmic_parameter(yield * s.deformation, 1e-4 * s.deformation, 5 * s.deformation),
           bounded_parameter(start.spread, 0.02, 0, 0.98), held(0, 0.005, 0, kMaxLoss),
           bounded_parameter(start.asymmetry, 0.02, -0.95, 0.95, start.asymmetry != 0)});
  return out;
}

/// Returns steel (sharp at first, rounder after yielding) and laws of constant sharpness.
LawStarts asymptotic(const LawScale& s) {
  LawStarts out{F::asymptotic, EffectKind::bilinear_hysteresis, {}};
  for (const bool steel : {true, false})
    for (const double yield : shrinking(0.9, 0.02, 0.65))
      out.shapes.push_back(
          {linear_parameter(1, 0.01 * s.stiffness),
           logarithmic_parameter(yield * s.deformation, 1e-4 * s.deformation, 5 * s.deformation),
           logarithmic_parameter(steel ? 15 : 4, 0.5, 60),
           bounded_parameter(steel ? 0.9 : 0, 0.02, 0, 0.99, steel)});
  return out;
}

/// Returns soil and joints whose loops are their first loading doubled.
LawStarts masing(const LawScale& s) {
  LawStarts out{F::masing, EffectKind::bilinear_hysteresis, {}};
  for (const double sharpness : {0.8, 1.6, 4.0})
    for (const double yield : shrinking(1.5, 0.02, 0.6))
      out.shapes.push_back(
          {linear_parameter(1, 0.01 * s.stiffness),
           logarithmic_parameter(yield * s.deformation, 1e-4 * s.deformation, 5 * s.deformation),
           logarithmic_parameter(sharpness, 0.2, 60)});
  return out;
}

/// Returns concrete: each half cycle returns toward the largest deformation so far.
LawStarts peak_oriented(const LawScale& s) {
  LawStarts out{F::peak_oriented, EffectKind::bilinear_hysteresis, {}};
  for (const double unloading : {0.0, 0.4})
    for (const double yield : shrinking(0.9, 0.04, 0.7))
      out.shapes.push_back(
          {linear_parameter(1, 0.01 * s.stiffness),
           logarithmic_parameter(yield * s.deformation, 1e-3 * s.deformation, 5 * s.deformation),
           held(unloading, 0.02, 0, 1)});
  return out;
}

/// offset; slip_work 0: the slip zone is open from the start.
Shape pinched(const LawScale& s, double yield, double exponent, double slip, double width,
              double offset, double slip_work) {
  Shape out = hysteretic(s, yield, exponent, 0.5);
  out[1].low = std::log(1e-3 * s.deformation);
  out.push_back(bounded_parameter(slip, 0.02, 0.3, 0.99));
  out.push_back(logarithmic_parameter(width, 0.05, 2.0));
  out.push_back(held(offset, 0.02, -0.5, 0.8));
  out.push_back(slip_work > 0 ? logarithmic_parameter(slip_work, 0.05, 100) : held(0, 1, 0, 0));
  add_losses(out);
  return out;
}

LawStarts slip_about_force(const LawScale& s) {
  LawStarts out{F::pinched, EffectKind::pinching, {}};
  for (const double slip : {0.7, 0.9})
    for (const double yield : shrinking(0.9, 0.004, 0.7))
      out.shapes.push_back(pinched(s, yield, 2, slip, 0.2, 0, 0));
  return out;
}

/// Returns wider zones beside zero force that open with work, as in walls and bolted joints.
LawStarts slip_that_opens(const LawScale& s) {
  LawStarts out{F::pinched, EffectKind::pinching, {}};
  for (const double width : {0.3, 0.6})
    for (const double yield : shrinking(0.9, 0.02, 0.6))
      out.shapes.push_back(pinched(s, yield, 1, 0.9, width, 0.1, 4));
  return out;
}

/// Returns laws with a slip zone around zero deformation: joints with play.
LawStarts slip_lock(const LawScale& s) {
  LawStarts out{F::slip_lock, EffectKind::pinching, {}};
  for (const double width : {0.15, 0.4})  // of the largest deformation
    for (const double yield : shrinking(0.9, 0.02, 0.6)) {
      Shape shape = hysteretic(s, yield, 2, 0.5);
      shape.push_back(bounded_parameter(0.85, 0.02, 0.3, 0.99));
      shape.push_back(logarithmic_parameter(width / yield, 0.05, 50));
      shape.push_back(held(0, 1, 0, 0));
      shape.push_back(held(0, 1, 0, 0));
      add_losses(shape);
      out.shapes.push_back(shape);
    }
  return out;
}

/// Returns braces that become slack by yielding.
LawStarts slack(const LawScale& s) {
  LawStarts out{F::slack, EffectKind::pinching, {}};
  for (const double play : {0.0, 0.1, 0.3})  // of the largest deformation
    for (const double yield : shrinking(0.8, 0.05, 0.7))
      out.shapes.push_back(
          {linear_parameter(1, 0.01 * s.stiffness),
           logarithmic_parameter(yield * s.deformation, 1e-3 * s.deformation, 2 * s.deformation),
           held(play * s.deformation, 0.005 * s.deformation, 0, s.deformation)});
  return out;
}

/// Returns springs that soften or harden up to a limit, from hyperbolic to two slopes.
LawStarts saturating(const LawScale& s) {
  LawStarts out{F::saturating, EffectKind::quadratic_stiffness, {}};
  for (const double shape : {1.0, 2.5, 8.0})
    for (const double d0 : {0.1, 0.25, 0.6})
      out.shapes.push_back(
          {linear_parameter(1, 0.01 * s.force()),
           logarithmic_parameter(d0 * s.deformation, 0.02 * s.deformation, 5 * s.deformation),
           logarithmic_parameter(shape, 0.3, 30)});
  return out;
}

LawStarts friction(const LawScale& s, bool stribeck) {
  LawStarts out{F::friction, EffectKind::coulomb_friction, {}};
  for (const double v0 : {0.1, 0.03, 0.01, 0.003})
    for (const double vs : stribeck ? std::vector<double>{0.1, 0.3} : std::vector<double>{0.2})
      out.shapes.push_back({linear_parameter(1, 0.01 * s.force()),
                            logarithmic_parameter(v0 * s.rate, 1e-4 * s.rate, 0.3 * s.rate),
                            bounded_parameter(stribeck ? 0.6 : 0, 0.02, -0.8, 8, stribeck),
                            logarithmic_parameter(vs * s.rate, 0.01 * s.rate, s.rate),
                            held(0, 0.005 * s.deformation, 0, 0.3 * s.deformation)});
  if (!stribeck)
    for (Shape& shape : out.shapes) shape[3].free = false;
  return out;
}

/// Returns true if the force has the velocity's sign; its amplitude is then not negative.
bool resists_velocity(LawForm form) {
  return is_hysteretic(form) || form == F::friction || form == F::power_damping;
}

}  // namespace

std::vector<LawStarts> contact_starts(const LawScale& s) {
  std::vector<LawStarts> out;
  for (const F form : {F::gap_positive, F::gap_negative, F::gap_both}) {
    out.push_back(
        {form, form == F::gap_both ? EffectKind::two_sided_gap : EffectKind::one_sided_gap, {}});
    const auto add = [&](double gap, double dashpot) {
      LawParameter damping =
          held(dashpot * s.deformation / s.rate, 0.01 * s.force() / s.rate, 0, 1e15);
      damping.free = dashpot > 0;
      out.back().shapes.push_back(
          {linear_parameter(1, 0.01 * s.stiffness),
           logarithmic_parameter(gap * s.deformation, 1e-3 * s.deformation, s.deformation),
           damping});
    };
    for (double g = 0.03; g < 0.97; g += g < 0.1 ? 0.03 : 0.07) add(g, 0);
    for (const double dashpot : {0.15, 0.5, 1.5})
      for (double g = 0.06; g < 0.9; g += 0.12) add(g, dashpot);
  }
  return out;
}

bool has_amplitude(const ModelEffect& effect, double amplitude) {
  const bool contact_damps = is_contact(effect.form) && effect.parameters[2].value > 0;
  return amplitude > 0 || !(contact_damps || resists_velocity(effect.form));
}

void set_amplitude(ModelEffect& effect, double amplitude) {
  effect.parameters[0].value = amplitude;
  if (is_contact(effect.form)) effect.parameters[2].value *= amplitude;
}

void scale_amplitude(double factor, ModelEffect& effect) {
  if (effect.parameters.empty()) return;
  LawParameter& size = effect.parameters[0];
  const double value = size.logarithmic ? size.value + std::log(factor) : size.value * factor;
  size.value = std::clamp(value, size.low, size.high);
}

std::vector<LawStarts> plain_starts(const LawScale& s) {
  std::vector<LawStarts> out;
  out.push_back({F::power, EffectKind::cubic_stiffness, {}});
  for (const double p : {1.5, 2.0, 3.0, 5.0})
    out.back().shapes.push_back(
        {linear_parameter(1, 0.01 * s.force()), bounded_parameter(p, 0.02, 1.2, 9)});
  out.push_back(saturating(s));
  out.push_back(friction(s, false));
  out.push_back(friction(s, true));
  out.push_back({F::power_damping, EffectKind::quadratic_damping, {}});
  for (const double p : {0.4, 1.5, 2.0, 3.0})
    out.back().shapes.push_back(
        {linear_parameter(1, 0.01 * s.force()), bounded_parameter(p, 0.02, 0.15, 5)});
  for (LawStarts& contact : contact_starts(s)) out.push_back(std::move(contact));
  return out;
}

std::vector<LawStarts> hysteretic_starts(const LawScale& s, bool pinching) {
  std::vector<LawStarts> out{bouc_wen(s, 1), bouc_wen(s, 2), bouc_wen(s, kBilinear),
                             degrading(s),   hardening(s),   sliders(s),
                             asymptotic(s),  masing(s),      peak_oriented(s)};
  if (pinching)
    for (LawStarts& one :
         std::vector<LawStarts>{slip_about_force(s), slip_that_opens(s), slip_lock(s), slack(s)})
      out.push_back(std::move(one));
  return out;
}

void free_shape(ModelEffect& effect) {
  using H = HysteresisIndex;
  std::vector<LawParameter>& p = effect.parameters;
  const auto release = [&](std::size_t index) {
    if (index < p.size() && p[index].high > p[index].low) p[index].free = true;
  };
  switch (effect.form) {
    case F::hysteresis:
      if (p[H::exponent].plain() > kSharpCorner) return;
      for (const std::size_t i : {+H::exponent, +H::beta, +H::strength_loss, +H::stiffness_loss})
        release(i);
      break;
    case F::pinched:
    case F::slip_lock:
      if (p[H::exponent].plain() > kSharpCorner) return;
      for (const std::size_t i :
           {+H::exponent, +H::beta, +H::offset, +H::pinched_strength, +H::pinched_stiffness})
        release(i);
      break;
    case F::slack:
      release(SlackIndex::play);
      break;
    case F::peak_oriented:
      release(PeakIndex::unloading);
      break;
    case F::friction:
      release(FrictionIndex::presliding);
      break;
    case F::amplitude:
      release(AmplitudeIndex::exponent);
      release(AmplitudeIndex::saturation);
      break;
    case F::sliders:
      release(SliderIndex::loss);
      release(SliderIndex::asymmetry);
      break;
    case F::asymptotic:
      release(AsymptoteIndex::loss);
      break;
    case F::gap_positive:
    case F::gap_negative:
    case F::gap_both:
      release(2);
      break;
    default:
      break;
  }
}

}  // namespace framewatch::estimator
