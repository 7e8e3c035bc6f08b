#include "estimator/simulate/hysteretic_law.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace framewatch::estimator {
namespace {

double sign(double x) {
  return x > 0 ? 1 : x < 0 ? -1 : 0;
}

/// A spring in series with a slider. The slider's position is what it remembers: exact while the
/// deformation is monotonic within a step.
class Bilinear : public ElementLaw {
 public:
  Bilinear(double kh, double dy) : kh_(kh), dy_(dy) {}
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

/// Springs in series with sliders, side by side, that yield one after the other and lose strength
/// with work. States: the deformation of each spring in units of dy, and the work.
class YieldingSprings : public ElementLaw {
 public:
  explicit YieldingSprings(const Effect& e)
      : kh_(e.value("kh_npm")),
        dy_(e.value("dy_m")),
        spread_(e.value("spread")),
        loss_(e.value("strength_loss")) {}
  int states() const override { return kSprings + 1; }
  double force(double, double, double, std::span<const double> z) const override {
    return kh_ * dy_ * mean(z);
  }
  void rates(double, double v, std::span<const double> z, std::span<double> rate) const override {
    const double weaker = 1 + loss_ * std::max(z[kSprings], 0.0);
    const double work = mean(z) * v / dy_;
    rate[kSprings] = work;
    for (std::size_t i = 0; i < kSprings; ++i) {
      const double limit =
          (1 + spread_ * ((2.0 * static_cast<double>(i) + 1) / kSprings - 1)) / weaker;
      const bool yields = std::abs(z[i]) >= limit && z[i] * v > 0;
      rate[i] = yields ? -sign(z[i]) * limit * loss_ / weaker * work : v / dy_;
    }
  }
  double stiffness_bound() const override { return kh_; }

 private:
  static constexpr std::size_t kSprings = 10;
  static double mean(std::span<const double> z) {
    double sum = 0;
    for (std::size_t i = 0; i < kSprings; ++i) sum += z[i];
    return sum / kSprings;
  }

  double kh_, dy_, spread_, loss_;
};

/// Bouc-Wen, and with a slip zone pinching. States: z, in m, and the work over kh dy^2.
class BoucWen : public ElementLaw {
 public:
  explicit BoucWen(const Effect& e)
      : kh_(e.value("kh_npm")),
        dy_(e.value("dy_m")),
        exponent_(e.value("exponent")),
        beta_(e.value("beta")),
        strength_loss_(e.value("strength_loss")),
        stiffness_loss_(e.value("stiffness_loss")) {
    if (e.kind == EffectKind::bouc_wen) {
      loading_ = e.value("loading");
      return;
    }
    slip_ = e.value("slip_ratio");
    width_ = e.value("slip_width") * dy_;
    offset_ = e.value("slip_offset") * dy_;
    slip_work_ = e.value("slip_work");
    slip_lock_ = e.value("slip_lock") > 0;
  }
  int states() const override { return 2; }
  double force(double, double, double, std::span<const double> z) const override {
    return kh_ * z[0];
  }
  void rates(double d, double v, std::span<const double> z, std::span<double> rate) const override {
    const double work = std::max(z[1], 0.0);
    const double yielded = (1 + strength_loss_ * work) * std::pow(std::abs(z[0]) / dy_, exponent_);
    const double at = slip_lock_ ? d : z[0] * sign(v) - offset_;
    double slip = slip_ > 0 ? slip_ * std::exp(-at * at / (width_ * width_)) : 0;
    if (slip_work_ > 0) slip *= 1 - std::exp(-work / slip_work_);
    rate[0] = (1 - slip) * v * (1 - yielded * (beta_ * sign(v * z[0]) + loading_ - beta_)) /
              (1 + stiffness_loss_ * work);
    rate[1] = z[0] * v / (dy_ * dy_);
  }
  double stiffness_bound() const override { return kh_; }

 private:
  double kh_, dy_, exponent_, beta_, strength_loss_, stiffness_loss_;
  double loading_ = 1, slip_ = 0, width_ = 1, offset_ = 0, slip_work_ = 0;
  bool slip_lock_ = false;
};

/// A brace that yields to either side and is slack up to where it has yielded.
class SlackBrace : public ElementLaw {
 public:
  explicit SlackBrace(const Effect& e)
      : kh_(e.value("kh_npm")), dy_(e.value("dy_m")), up_(e.value("play_m")), down_(up_) {}
  double force(double, double d, double, std::span<const double>) const override {
    return kh_ * (std::clamp(d - up_, 0.0, dy_) - std::clamp(-d - down_, 0.0, dy_));
  }
  void begin_step(double, double d) override {
    up_ = std::max(up_, d - dy_);
    down_ = std::max(down_, -d - dy_);
  }
  double stiffness_bound() const override { return kh_; }

 private:
  double kh_, dy_, up_, down_;
};

}  // namespace

std::unique_ptr<ElementLaw> make_slider(double kh, double dy) {
  return std::make_unique<Bilinear>(kh, dy);
}

std::unique_ptr<ElementLaw> make_hysteretic_law(const Effect& e) {
  if (e.kind == EffectKind::pinching && e.value("slack") > 0)
    return std::make_unique<SlackBrace>(e);
  if (e.kind != EffectKind::bilinear_hysteresis) return std::make_unique<BoucWen>(e);
  if (e.value("spread") > 0 || e.value("strength_loss") > 0)
    return std::make_unique<YieldingSprings>(e);
  return make_slider(e.value("kh_npm"), e.value("dy_m"));
}

}  // namespace framewatch::estimator
