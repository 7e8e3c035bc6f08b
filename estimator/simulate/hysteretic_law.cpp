// SPDX-License-Identifier: MIT
#include "estimator/simulate/hysteretic_law.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace framewatch::estimator {
namespace {

double sign(double x) {
  return x > 0 ? 1 : x < 0 ? -1 : 0;
}

/// A spring in series with a slider. The memory is the slider's position, which is exact while the
/// deformation is monotonic within a step.
class Bilinear : public ElementLaw {
 public:
  Bilinear(double kh, double dy) : kh_(kh), dy_(dy) {}
  double force(double, double d, double, std::span<const double>) const override {
    return kh_ * std::clamp(d - slider_, -dy_, dy_);
  }
  void begin_step(double, double d) override { slider_ = d - std::clamp(d - slider_, -dy_, dy_); }
  double stiffness_bound() const override { return kh_; }
  std::vector<double> memory() const override { return {slider_}; }
  void remember(std::span<const double> memory) override { slider_ = memory[0]; }

 private:
  double kh_, dy_;
  double slider_ = 0;
};

/// Parallel springs in series with sliders that yield one after the other and lose strength with
/// work. States: the deformation of each spring in units of dy, and the work.
class YieldingSprings : public ElementLaw {
 public:
  explicit YieldingSprings(const Effect& e)
      : kh_(e.value("kh_npm")),
        dy_(e.value("dy_m")),
        spread_(e.value("spread")),
        loss_(e.value("strength_loss")),
        asymmetry_(e.value("asymmetry")) {}
  int states() const override { return kSprings + 1; }
  double force(double, double, double, std::span<const double> z) const override {
    return kh_ * dy_ * mean(z);
  }
  void rates(double, double v, std::span<const double> z, std::span<double> rate) const override {
    const double weaker = 1 + loss_ * std::max(z[kSprings], 0.0);
    const double work = mean(z) * v / dy_;
    rate[kSprings] = work;
    for (std::size_t i = 0; i < kSprings; ++i) {
      const double limit = (1 + spread_ * ((2.0 * static_cast<double>(i) + 1) / kSprings - 1)) /
                           weaker * (1 + sign(z[i]) * asymmetry_);
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

  double kh_, dy_, spread_, loss_, asymmetry_;
};

/// Round yielding that follows Masing's rule: parallel springs in series with sliders that yield
/// one after the other (Iwan 1966). States: the deformation of each spring in units of dy.
class RoundYielding : public ElementLaw {
 public:
  explicit RoundYielding(const Effect& e) : kh_(e.value("kh_npm")), dy_(e.value("dy_m")) {
    const double sharpness = e.value("sharpness");
    const double first = reached(kFirst, sharpness), last = reached(kLast, sharpness);
    const double ratio = std::pow(last / first, 1.0 / (kSprings - 1));
    double before = 1;
    for (std::size_t i = 0; i < kSprings; ++i) {
      limit_[i] = first * std::pow(ratio, static_cast<double>(i));
      const double next = limit_[i] * std::sqrt(ratio);
      const double after = std::exp(-(1 + 1 / sharpness) * std::log1p(std::pow(next, sharpness)));
      share_[i] = before - after;
      before = after;
    }
    elastic_ = before;
  }
  int states() const override { return kSprings; }
  double force(double, double d, double, std::span<const double> z) const override {
    double sum = elastic_ * d / dy_;
    for (std::size_t i = 0; i < kSprings; ++i) sum += share_[i] * z[i];
    return kh_ * dy_ * sum;
  }
  void rates(double, double v, std::span<const double> z, std::span<double> rate) const override {
    for (std::size_t i = 0; i < kSprings; ++i)
      rate[i] = std::abs(z[i]) >= limit_[i] && z[i] * v > 0 ? 0 : v / dy_;
  }
  double stiffness_bound() const override { return kh_; }

 private:
  static constexpr std::size_t kSprings = 100;
  static constexpr double kFirst = 0.99, kLast = 5e-4;  // slopes between which springs yield
  /// Returns d/dy where first loading has this slope, over kh.
  static double reached(double slope, double sharpness) {
    return std::pow(std::pow(slope, -sharpness / (1 + sharpness)) - 1, 1 / sharpness);
  }

  double kh_, dy_, elastic_ = 0;
  std::array<double, kSprings> limit_, share_;
};

/// Bouc-Wen; with a slip zone, pinching. States: z, m, and the work over kh dy^2.
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

/// Yielding that returns toward the largest deformation so far. The memory is where z stands and
/// the corners of the path ahead, which is exact while the deformation is monotonic within a step.
class PeakOrientedYielding : public ElementLaw {
 public:
  explicit PeakOrientedYielding(const Effect& e)
      : kh_(e.value("kh_npm")), dy_(e.value("dy_m")), unloading_(e.value("unloading")) {
    for (Side& side : sides_) side.peak = dy_;
  }
  double force(double, double d, double, std::span<const double>) const override {
    return kh_ * z_at(d);
  }
  void begin_step(double, double d) override {
    if (d == now_.d) return;
    const double to = d > now_.d ? 1 : -1;
    mark_turn(sides_[to > 0 ? 1 : 0], -to);
    const double z = z_at(d);
    now_ = {d, z};
    for (const double of : {1.0, -1.0}) {
      Side& side = sides_[of > 0 ? 0 : 1];
      side.peak = std::max(side.peak, of * d);
      if (of * z <= 0 || of * d >= side.turn.d) side.turn = kNone;
    }
  }
  double stiffness_bound() const override { return kh_; }
  std::vector<double> memory() const override {
    std::vector<double> out{now_.d, now_.z};
    for (const Side& side : sides_) out.insert(out.end(), {side.peak, side.turn.d, side.turn.z});
    return out;
  }
  void remember(std::span<const double> memory) override {
    now_ = {memory[0], memory[1]};
    for (std::size_t i = 0; i < sides_.size(); ++i)
      sides_[i] = {memory[2 + 3 * i], {memory[3 + 3 * i], memory[4 + 3 * i]}};
  }

 private:
  struct Point {
    double d, z;
  };
  static constexpr Point kNone{-1e6, 0};  // m, below every deformation
  /// Deformations and z are positive toward the side.
  struct Side {
    double peak = 0;     ///< largest deformation so far
    Point turn = kNone;  ///< where it began to unload, until z = 0
  };

  void mark_turn(Side& side, double of) const {
    if (of * now_.z > 0 && of * now_.d > side.turn.d) side.turn = {of * now_.d, of * now_.z};
  }
  double slope(const Side& side) const { return std::pow(side.peak / dy_, -unloading_); }
  double z_at(double d) const {
    const double to = d > now_.d ? 1 : -1;
    const Side &ahead = sides_[to > 0 ? 0 : 1], &behind = sides_[to > 0 ? 1 : 0];
    Point from{to * now_.d, to * now_.z};
    const Point zero{from.d - from.z / slope(behind), 0};
    for (const Point& corner : {from.z < 0 ? zero : ahead.turn, Point{ahead.peak, dy_}}) {
      if (corner.d <= from.d) continue;
      if (to * d < corner.d)
        return to * (from.z + (corner.z - from.z) * (to * d - from.d) / (corner.d - from.d));
      from = corner;
    }
    return to * dy_;
  }

  double kh_, dy_, unloading_;
  Point now_{0, 0};
  std::array<Side, 2> sides_;
};

/// A brace that yields to either side and then is slack up to where it yielded.
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
  std::vector<double> memory() const override { return {up_, down_}; }
  void remember(std::span<const double> memory) override {
    up_ = memory[0];
    down_ = memory[1];
  }

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
  if (e.value("peak_oriented") > 0) return std::make_unique<PeakOrientedYielding>(e);
  if (e.value("sharpness") > 0) return std::make_unique<RoundYielding>(e);
  if (e.value("spread") > 0 || e.value("strength_loss") > 0 || e.value("asymmetry") != 0)
    return std::make_unique<YieldingSprings>(e);
  return make_slider(e.value("kh_npm"), e.value("dy_m"));
}

}  // namespace framewatch::estimator
