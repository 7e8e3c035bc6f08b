#include "estimator/simulate/make_law.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "estimator/simulate/hysteretic_law.h"

namespace framewatch::estimator {
namespace {

/// f(d) alone, without memory.
class ElasticLaw : public ElementLaw {
 public:
  explicit ElasticLaw(const Effect& e) : kind_(e.kind) {
    using enum EffectKind;
    if (kind_ == cubic_stiffness) stiffness_ = e.value("k3_npm3");
    if (kind_ == quadratic_stiffness) stiffness_ = e.value("k2_npm2");
  }
  double force(double, double d, double, std::span<const double>) const override {
    return stiffness_ * d * (kind_ == EffectKind::cubic_stiffness ? d * d : std::abs(d));
  }

 private:
  EffectKind kind_;
  double stiffness_ = 0;
};

/// A clearance that closes; then a spring and a dashpot that only push.
class Contact : public ElementLaw {
 public:
  explicit Contact(const Effect& e)
      : stiffness_(e.value("kg_npm")), gap_(e.value("gap_m")), damping_(e.value("cg_nspm")) {
    if (e.kind != EffectKind::one_sided_gap) return;
    up_ = e.value("side") > 0;
    down_ = !up_;
  }
  double force(double, double d, double v, std::span<const double>) const override {
    return (up_ ? push(d, v) : 0) - (down_ ? push(-d, -v) : 0);
  }
  double stiffness_bound() const override { return stiffness_; }
  double damping_bound() const override { return damping_; }

 private:
  double push(double d, double v) const {
    return d > gap_ ? std::max(stiffness_ * (d - gap_) + damping_ * v, 0.0) : 0;
  }

  double stiffness_, gap_, damping_;
  bool up_ = true, down_ = true;
};

/// One story of amplitude_dependence, elastic.
class AmplitudeDependence : public ElementLaw {
 public:
  AmplitudeDependence(const Effect& e, double stiffness)
      : softening_(stiffness * e.value("softening")),
        at_m_(e.value("at_m")),
        exponent_(e.value("exponent")),
        damping_(stiffness * e.value("damping_s2pm")) {}
  double force(double, double d, double v, std::span<const double>) const override {
    return damping_ * v * std::abs(v) -
           softening_ * d * std::pow(std::abs(d) / at_m_, exponent_ - 1);
  }

 private:
  double softening_, at_m_, exponent_, damping_;
};

/// The same with joints that slip: springs in series with sliders that give way one after the other
/// (Iwan 1966), so many that their force at first loading is the power. States: the deformation of
/// each spring, m.
class SlippingJoints : public ElementLaw {
 public:
  SlippingJoints(const Effect& e, double stiffness)
      : elastic_(e, stiffness), slip_(e.value("slip")) {
    const double at_m = e.value("at_m"), exponent = e.value("exponent");
    const double ratio = std::pow(kLargest / kSmallest, 1.0 / (kSprings - 1));
    double below = 0;
    for (std::size_t i = 0; i < kSprings; ++i) {
      const double limit = kSmallest * std::pow(ratio, static_cast<double>(i));
      const double slipping = stiffness * e.value("softening") * exponent *
                              std::pow(limit * std::sqrt(ratio), exponent - 1);
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

class QuadraticDamping : public ElementLaw {
 public:
  explicit QuadraticDamping(const Effect& e) : c2_(e.value("c2_ns2pm2")) {}
  double force(double, double, double v, std::span<const double>) const override {
    return c2_ * v * std::abs(v);
  }

 private:
  double c2_;
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

/// Friction that gives way before it slides.
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
    // What is faster than the shortest step is over within it.
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

/// dk d from t0 on; it begins with a step of the integration.
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

class StiffnessDrift : public ElementLaw {
 public:
  explicit StiffnessDrift(const Effect& e)
      : change_(e.value("dk_npm")),
        from_s_(e.value("from_s")),
        duration_s_(e.value("duration_s")) {}
  double force(double time_s, double d, double, std::span<const double>) const override {
    return change_ * std::clamp((time_s - from_s_) / duration_s_, 0.0, 1.0) * d;
  }
  double stiffness_bound() const override { return std::abs(change_); }

 private:
  double change_, from_s_, duration_s_;
};

/// Second-order effect of the weight above.
class PDelta : public ElementLaw {
 public:
  PDelta(const Effect& e, const Structure& s)
      : stiffness_(-e.value("weight_n") /
                   s.story_height[static_cast<std::size_t>(e.place.story - 1)]) {}
  double force(double, double d, double, std::span<const double>) const override {
    return stiffness_ * d;
  }
  double stiffness_bound() const override { return std::abs(stiffness_); }

 private:
  double stiffness_;
};

}  // namespace

std::unique_ptr<ElementLaw> make_amplitude_law(const Effect& e, double stiffness) {
  if (e.value("slip") > 0) return std::make_unique<SlippingJoints>(e, stiffness);
  return std::make_unique<AmplitudeDependence>(e, stiffness);
}

std::unique_ptr<ElementLaw> make_law(const Effect& e, const Structure& s) {
  switch (e.kind) {
    case EffectKind::cubic_stiffness:
    case EffectKind::quadratic_stiffness:
      return std::make_unique<ElasticLaw>(e);
    case EffectKind::one_sided_gap:
    case EffectKind::two_sided_gap:
      return std::make_unique<Contact>(e);
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
      return std::make_unique<QuadraticDamping>(e);
    case EffectKind::stiffness_drop:
      return std::make_unique<StiffnessDrop>(e);
    case EffectKind::stiffness_drift:
      return std::make_unique<StiffnessDrift>(e);
    case EffectKind::p_delta:
      return std::make_unique<PDelta>(e, s);
    default:
      return nullptr;
  }
}

}  // namespace framewatch::estimator
