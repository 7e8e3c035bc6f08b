#include "estimator/simulate/element_law.h"

#include <algorithm>
#include <cmath>

namespace framewatch::estimator {
namespace {

double sign(double x) {
  return x > 0 ? 1 : x < 0 ? -1 : 0;
}

/// f(d) alone, without memory.
class ElasticLaw : public ElementLaw {
 public:
  explicit ElasticLaw(const Effect& e) : kind_(e.kind) {
    using enum EffectKind;
    if (kind_ == cubic_stiffness) stiffness_ = e.value("k3_npm3");
    if (kind_ == quadratic_stiffness) stiffness_ = e.value("k2_npm2");
    if (kind_ == one_sided_gap || kind_ == two_sided_gap) {
      stiffness_ = e.value("kg_npm");
      gap_ = e.value("gap_m");
    }
    if (kind_ == one_sided_gap) side_ = e.value("side");
  }
  double force(double, double d, double, std::span<const double>) const override {
    switch (kind_) {
      case EffectKind::cubic_stiffness:
        return stiffness_ * d * d * d;
      case EffectKind::quadratic_stiffness:
        return stiffness_ * d * std::abs(d);
      case EffectKind::one_sided_gap:
        return side_ * stiffness_ * std::max(side_ * d - gap_, 0.0);
      default:
        return stiffness_ * (std::max(d - gap_, 0.0) - std::max(-d - gap_, 0.0));
    }
  }
  double stiffness_bound() const override {
    const bool contact = kind_ == EffectKind::one_sided_gap || kind_ == EffectKind::two_sided_gap;
    return contact ? stiffness_ : 0;
  }

 private:
  EffectKind kind_;
  double stiffness_ = 0;
  double gap_ = 0;
  double side_ = 1;
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
  explicit Friction(const Effect& e) : force_(e.value("fc_n")), v0_(e.value("v0_mps")) {}
  double force(double, double, double v, std::span<const double>) const override {
    return force_ * std::tanh(v / v0_);
  }
  double damping_bound() const override { return force_ / v0_; }

 private:
  double force_, v0_;
};

/// A spring in series with a slider. The slider's position is what it remembers: exact while the
/// deformation is monotonic within a step.
class Bilinear : public ElementLaw {
 public:
  explicit Bilinear(const Effect& e) : kh_(e.value("kh_npm")), dy_(e.value("dy_m")) {}
  double force(double, double d, double, std::span<const double>) const override {
    return kh_ * std::clamp(d - slider_, -dy_, dy_);
  }
  void begin_step(double, double d) override { slider_ = d - std::clamp(d - slider_, -dy_, dy_); }
  double stiffness_bound() const override { return kh_; }
  double remembered() const override { return slider_; }
  void remember(double slider) override { slider_ = slider; }

 private:
  double kh_, dy_;
  double slider_ = 0;
};

/// Bouc-Wen, and with a slip zone pinching. z is the state, in m.
class BoucWen : public ElementLaw {
 public:
  explicit BoucWen(const Effect& e)
      : kh_(e.value("kh_npm")),
        dy_(e.value("dy_m")),
        exponent_(e.value("exponent")),
        beta_(e.value("beta")) {
    if (e.kind != EffectKind::pinching) return;
    slip_ = e.value("slip_ratio");
    width_ = e.value("slip_width") * dy_;
  }
  int states() const override { return 1; }
  double force(double, double, double, std::span<const double> z) const override {
    return kh_ * z[0];
  }
  void rates(double, double v, std::span<const double> z, std::span<double> rate) const override {
    const double yielded = std::pow(std::abs(z[0]) / dy_, exponent_);
    const double slip = slip_ > 0 ? slip_ * std::exp(-z[0] * z[0] / (width_ * width_)) : 0;
    rate[0] = (1 - slip) * v * (1 - yielded * (beta_ * sign(v * z[0]) + 1 - beta_));
  }
  double stiffness_bound() const override { return kh_; }

 private:
  double kh_, dy_, exponent_, beta_;
  double slip_ = 0;
  double width_ = 1;
};

/// dk d from t0 on; it begins with a step of the integration.
class StiffnessDrop : public ElementLaw {
 public:
  explicit StiffnessDrop(const Effect& e) : change_(e.value("dk_npm")), at_s_(e.value("at_s")) {}
  double force(double, double d, double, std::span<const double>) const override {
    return dropped_ ? change_ * d : 0;
  }
  void begin_step(double time_s, double) override {
    constexpr double kRounding_s = 1e-9;
    dropped_ = time_s >= at_s_ - kRounding_s;
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

void ElementLaw::rates(double, double, std::span<const double>, std::span<double>) const {}

void ElementLaw::begin_step(double, double) {}

std::unique_ptr<ElementLaw> make_law(const Effect& e, const Structure& s) {
  switch (e.kind) {
    case EffectKind::cubic_stiffness:
    case EffectKind::quadratic_stiffness:
    case EffectKind::one_sided_gap:
    case EffectKind::two_sided_gap:
      return std::make_unique<ElasticLaw>(e);
    case EffectKind::bilinear_hysteresis:
      return std::make_unique<Bilinear>(e);
    case EffectKind::bouc_wen:
    case EffectKind::pinching:
      return std::make_unique<BoucWen>(e);
    case EffectKind::coulomb_friction:
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
