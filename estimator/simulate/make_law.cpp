// SPDX-License-Identifier: MIT
#include "estimator/simulate/make_law.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <utility>

#include "estimator/simulate/hysteretic_law.h"

namespace framewatch::estimator {
namespace {

/// A law without memory: a force of time, deformation and rate.
class ForceLaw : public ElementLaw {
 public:
  using Force = std::function<double(double time_s, double d, double v)>;

  explicit ForceLaw(Force force, double stiffness_bound = 0, double damping_bound = 0)
      : force_(std::move(force)), stiffness_(stiffness_bound), damping_(damping_bound) {}
  double force(double time_s, double d, double v, std::span<const double>) const override {
    return force_(time_s, d, v);
  }
  double stiffness_bound() const override { return stiffness_; }
  double damping_bound() const override { return damping_; }

 private:
  Force force_;
  double stiffness_, damping_;
};

/// Returns the share of its stiffness that a saturating spring has lost at u = d/d0.
double lost_share(double u, double shape) {
  return -std::expm1(-std::log1p(std::pow(std::abs(u), shape)) / shape);
}

/// The curve y(x) of amplitude_dependence, 1 at the reference deformation: a power, or one that
/// saturates.
class Softens {
 public:
  explicit Softens(const Effect& e)
      : exponent_(e.value("exponent")), saturation_(e.value("saturation_m") / e.value("at_m")) {
    if (saturation_ > 0) scale_ = 1 / lost_share(1 / saturation_, exponent_ - 1);
  }
  /// Returns y/x.
  double share(double x) const {
    if (saturation_ > 0) return scale_ * lost_share(x / saturation_, exponent_ - 1);
    return std::pow(std::abs(x), exponent_ - 1);
  }
  /// x: > 0.
  double slope(double x) const {
    if (!(saturation_ > 0)) return exponent_ * std::pow(x, exponent_ - 1);
    const double shape = exponent_ - 1, level = std::log1p(std::pow(x / saturation_, shape));
    return -scale_ * std::expm1(-(1 / shape + 1) * level);
  }

 private:
  double exponent_, saturation_, scale_ = 1;
};

/// One story of an elastic amplitude_dependence.
class AmplitudeDependence : public ElementLaw {
 public:
  AmplitudeDependence(const Effect& e, double stiffness)
      : softening_(stiffness * e.value("softening")),
        at_m_(e.value("at_m")),
        damping_(stiffness * e.value("damping_s2pm")),
        curve_(e) {}
  double force(double, double d, double v, std::span<const double>) const override {
    return damping_ * v * std::abs(v) - softening_ * d * curve_.share(d / at_m_);
  }

 private:
  double softening_, at_m_, damping_;
  Softens curve_;
};

/// One story of amplitude_dependence with slipping joints: springs in series with sliders that
/// yield one after the other (Iwan 1966). There are enough of them that the force at first loading
/// is the law's curve. States: the deformation of each spring, m.
class SlippingJoints : public ElementLaw {
 public:
  SlippingJoints(const Effect& e, double stiffness)
      : elastic_(e, stiffness), slip_(e.value("slip")) {
    const double at_m = e.value("at_m");
    const Softens curve(e);
    const double ratio = std::pow(kLargest / kSmallest, 1.0 / (kSprings - 1));
    double below = 0;
    for (std::size_t i = 0; i < kSprings; ++i) {
      const double limit = kSmallest * std::pow(ratio, static_cast<double>(i));
      const double slipping =
          stiffness * e.value("softening") * curve.slope(limit * std::sqrt(ratio));
      springs_[i] = {slipping - below, limit * at_m};
      below = slipping;
    }
    all_ = below;
  }
  int states() const override { return kSprings; }
  double force(double time_s, double d, double v, std::span<const double> z) const override {
    double slipped = all_ * d;
    for (std::size_t i = 0; i < kSprings; ++i) slipped -= springs_[i].stiffness * z[i];
    const double elastic = elastic_.force(time_s, d, 0, {});
    return elastic_.force(time_s, 0, v, {}) + (1 - slip_) * elastic - slip_ * slipped;
  }
  void rates(double, double v, std::span<const double> z, std::span<double> rate) const override {
    for (std::size_t i = 0; i < kSprings; ++i)
      rate[i] = std::abs(z[i]) >= springs_[i].limit_m && z[i] * v > 0 ? 0 : v;
  }

 private:
  static constexpr std::size_t kSprings = 40;
  static constexpr double kSmallest = 1e-3, kLargest = 10;  // limits, of at_m
  struct Spring {
    double stiffness, limit_m;
  };
  AmplitudeDependence elastic_;
  double slip_, all_ = 0;
  std::array<Spring, kSprings> springs_;
};

class Friction : public ElementLaw {
 public:
  explicit Friction(const Effect& e)
      : force_(e.value("fc_n")),
        v0_(e.value("v0_mps")),
        static_(e.value("static_ratio")),
        stribeck_(e.value("stribeck_mps")) {}
  double force(double, double, double v, std::span<const double>) const override {
    const double more = static_ * std::exp(-(v / stribeck_) * (v / stribeck_));
    return force_ * (1 + more) * std::tanh(v / v0_);
  }
  double damping_bound() const override { return force_ * (1 + std::max(static_, 0.0)) / v0_; }

 private:
  double force_, v0_, static_, stribeck_;
};

/// Friction with elastic deflection before it slides.
class PreslidingFriction : public ElementLaw {
 public:
  explicit PreslidingFriction(const Effect& e)
      : steady_(e),
        force_(e.value("fc_n")),
        v0_(e.value("v0_mps")),
        give_(e.value("presliding_m")) {}
  int states() const override { return 1; }
  double force(double, double, double, std::span<const double> z) const override {
    return force_ * z[0];
  }
  void rates(double, double v, std::span<const double> z, std::span<double> z_rate) const override {
    // Anything faster than the shortest step is over within it.
    constexpr double kFastest_per_s = 4000;
    if (std::abs(v) < kAtRest * v0_) v = kAtRest * v0_;
    const double steady = steady_.force(0, 0, v, {}) / force_;
    z_rate[0] = std::min(std::abs(v / steady) / give_, kFastest_per_s) * (steady - z[0]);
  }
  double stiffness_bound() const override { return force_ / give_; }

 private:
  static constexpr double kAtRest = 1e-6;
  Friction steady_;
  double force_, v0_, give_;
};

/// dk d from t0 on; it starts with a step of the integration.
class StiffnessDrop : public ElementLaw {
 public:
  explicit StiffnessDrop(const Effect& e) : change_(e.value("dk_npm")), at_s_(e.value("at_s")) {}
  double force(double, double d, double, std::span<const double>) const override {
    return dropped_ ? change_ * d : 0;
  }
  void begin_step(double time_s, double) override {
    constexpr double kDropRounding_s = 1e-9;
    dropped_ = time_s >= at_s_ - kDropRounding_s;
  }
  double stiffness_bound() const override { return std::abs(change_); }

 private:
  double change_, at_s_;
  bool dropped_ = false;
};

std::unique_ptr<ElementLaw> without_memory(ForceLaw::Force force, double stiffness_bound = 0,
                                           double damping_bound = 0) {
  return std::make_unique<ForceLaw>(std::move(force), stiffness_bound, damping_bound);
}

/// Returns a spring that is the power `exponent` of the deformation, or that up to its saturation.
std::unique_ptr<ElementLaw> make_spring(const Effect& e, double size, int exponent) {
  const double d0 = e.value("saturation_m"), shape = e.value("shape");
  if (!(d0 > 0))
    return without_memory(
        [=](double, double d, double) { return size * d * (exponent == 3 ? d * d : std::abs(d)); });
  const double most = size * std::pow(d0, exponent - 1) * shape;
  return without_memory(
      [=](double, double d, double) { return most * d * lost_share(d / d0, shape); },
      std::abs(most));
}

/// Returns a clearance that closes onto a spring and a dashpot that only push.
std::unique_ptr<ElementLaw> make_contact(const Effect& e) {
  const double stiffness = e.value("kg_npm"), gap = e.value("gap_m"), damping = e.value("cg_nspm");
  const bool both = e.kind != EffectKind::one_sided_gap;
  const bool up = both || e.value("side") > 0, down = both || !up;
  const auto push = [=](double d, double v) {
    return d > gap ? std::max(stiffness * (d - gap) + damping * v, 0.0) : 0;
  };
  return without_memory(
      [=](double, double d, double v) { return (up ? push(d, v) : 0) - (down ? push(-d, -v) : 0); },
      stiffness, damping);
}

std::unique_ptr<ElementLaw> make_drift(const Effect& e) {
  const double change = e.value("dk_npm");
  return without_memory(
      [=, from_s = e.value("from_s"), duration_s = e.value("duration_s")](double time_s, double d,
                                                                          double) {
        return change * std::clamp((time_s - from_s) / duration_s, 0.0, 1.0) * d;
      },
      std::abs(change));
}

/// Returns the second-order effect of the weight above.
std::unique_ptr<ElementLaw> make_p_delta(const Effect& e, const Structure& s) {
  const double stiffness =
      -e.value("weight_n") / s.story_height[static_cast<std::size_t>(e.place.story - 1)];
  return without_memory([=](double, double d, double) { return stiffness * d; },
                        std::abs(stiffness));
}

}  // namespace

std::unique_ptr<ElementLaw> make_amplitude_law(const Effect& e, double stiffness) {
  if (e.value("slip") > 0) return std::make_unique<SlippingJoints>(e, stiffness);
  return std::make_unique<AmplitudeDependence>(e, stiffness);
}

std::unique_ptr<ElementLaw> make_law(const Effect& e, const Structure& s) {
  switch (e.kind) {
    case EffectKind::cubic_stiffness:
      return make_spring(e, e.value("k3_npm3"), 3);
    case EffectKind::quadratic_stiffness:
      return make_spring(e, e.value("k2_npm2"), 2);
    case EffectKind::one_sided_gap:
    case EffectKind::two_sided_gap:
      return make_contact(e);
    case EffectKind::bilinear_hysteresis:
    case EffectKind::bouc_wen:
    case EffectKind::pinching:
      return make_hysteretic_law(e);
    case EffectKind::coulomb_friction:
      if (const double ks = e.value("stick_npm"); ks > 0)
        return make_slider(ks, e.value("fc_n") / ks);
      if (e.value("presliding_m") > 0 && e.value("fc_n") > 0)
        return std::make_unique<PreslidingFriction>(e);
      return std::make_unique<Friction>(e);
    case EffectKind::quadratic_damping:
      return without_memory(
          [c2 = e.value("c2_ns2pm2")](double, double, double v) { return c2 * v * std::abs(v); });
    case EffectKind::stiffness_drop:
      return std::make_unique<StiffnessDrop>(e);
    case EffectKind::stiffness_drift:
      return make_drift(e);
    case EffectKind::p_delta:
      return make_p_delta(e, s);
    default:
      return nullptr;
  }
}

}  // namespace framewatch::estimator
