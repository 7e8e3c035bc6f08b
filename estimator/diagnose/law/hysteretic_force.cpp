// SPDX-License-Identifier: MIT
#include "estimator/diagnose/law/hysteretic_force.h"

#include <algorithm>
#include <cmath>

namespace framewatch::estimator {
namespace {

using H = HysteresisIndex;
using S = SliderIndex;

constexpr double kLongestSlide = 0.1;  ///< of z per integration step, in units of dy
constexpr double kYielded = 1e-12;     ///< change of z below which the integration stops
constexpr double kMaxSlides = 5000;
/// Shares of the first slope. Below kNearlyYielded the rest of the step has a closed form; below
/// kYields the steps are longer.
constexpr double kNearlyYielded = 1e-3, kYields = 0.1;
constexpr double kLongerSlide = 0.25;
constexpr double kLargestZ = 1e3;  ///< of hysteresis that hardens
/// Square of the distance from a slip zone, in its widths, beyond which the zone has no influence.
constexpr double kOutside = 40;

/// Slope dz/dd of one law, in units of dy.
class Slope {
 public:
  Slope(const LawValues& values, const WornShape& shape)
      : p_(values.p), shape_(shape), pinched_(values.form == LawForm::pinched) {
    if (values.form == LawForm::hysteresis)
      loading_ = value_or(p_, H::loading, 1);
    else if (pinched_)
      offset_ = value_or(p_, H::offset, 0);
  }

  double operator()(double z, double d, double direction) const {
    return slip(z, d, direction) * without_slip(z, direction);
  }

  /// Returns the share of the slope that the slip zone leaves.
  double slip(double z, double d, double direction) const {
    if (shape_.slip == 0) return 1;
    const double at = (pinched_ ? z * direction - offset_ : d) / p_[H::width];
    return at * at < kOutside ? 1 - shape_.slip * std::exp(-at * at) : 1.0;
  }

  double without_slip(double z, double direction) const {
    const double level = shape_.weaker * power_of(std::abs(z), p_[H::exponent]);
    const double turn = p_[H::beta] * (z * direction > 0 ? 1.0 : -1.0) + loading_ - p_[H::beta];
    return (1 - level * turn) / shape_.softer;
  }

  /// Returns the share of the first slope that loading has left.
  double share(double rising) const { return rising * shape_.softer; }

  /// Returns z after a slide by `left` that starts where its share is small. z approaches its limit
  /// as exp(-rate travel); the slope's change with z is held constant.
  double at_end(double z, double d, double direction, double left, double rising) const {
    const double rate = p_[H::exponent] * (1 - share(rising)) / (std::abs(z) * shape_.softer);
    const double travel = pinched_ ? left * slip(z, d, direction) : slid(d, direction, left);
    return z - direction * rising / rate * std::expm1(-rate * travel);
  }

 private:
  /// Returns the integral of slip() for a zone around zero deformation.
  double slid(double d, double direction, double left) const {
    if (shape_.slip == 0) return left;
    const double width = p_[H::width], to = d + direction * left;
    const double zone = std::abs(std::erf(to / width) - std::erf(d / width));
    return left - shape_.slip * width * 0.5 * std::sqrt(M_PI) * zone;
  }

  const std::vector<double>& p_;
  const WornShape& shape_;
  bool pinched_;
  double loading_ = 1, offset_ = 0;
};

/// Returns the deformation at which a slider yields.
double limit_of(const LawValues& values, std::size_t slider, double weaker) {
  const double place = (2.0 * static_cast<double>(slider) + 1) / S::kCount - 1;
  return values.p[S::dy] * (1 + values.p[S::spread] * place) / weaker;
}

/// Returns how far the spring of one slider is stretched, if the slider yields at this limit.
double spring_stretch(const LawValues& values, double stretch, double limit) {
  const double asymmetry = value_or(values.p, S::asymmetry, 0);
  return std::clamp(stretch, -limit * (1 - asymmetry), limit * (1 + asymmetry));
}

double weaker_of(const LawValues& values, double work) {
  return std::max(1 + value_or(values.p, S::loss, 0) * work, 0.1);
}

}  // namespace

double bent(double x, double sharpness) {
  return x > 1 ? 1 / std::pow(1 + std::pow(1 / x, sharpness), 1 / sharpness)
               : x / std::pow(1 + std::pow(x, sharpness), 1 / sharpness);
}

double power_of(double x, double p) {
  return p == 1 ? x : p == 2 ? x * x : p == 3 ? x * x * x : std::pow(x, p);
}

double value_or(const std::vector<double>& p, std::size_t index, double without) {
  return index < p.size() ? p[index] : without;
}

WornShape worn_shape(const LawValues& values, double work) {
  const std::vector<double>& p = values.p;
  const bool plain = values.form == LawForm::hysteresis;
  const double strength = value_or(p, plain ? +H::strength_loss : +H::pinched_strength, 0);
  const double stiffness = value_or(p, plain ? +H::stiffness_loss : +H::pinched_stiffness, 0);
  const double loading = plain ? value_or(p, H::loading, 1) : 1;
  WornShape out;
  out.weaker = 1 + std::max(strength * work, -0.9);
  out.softer = 1 + std::max(stiffness * work, -0.9);
  const double level = out.weaker * loading;
  out.most = level == 1 ? 1 : loading > 0 ? std::pow(1 / level, 1 / p[H::exponent]) : kLargestZ;
  if (plain) return out;
  out.slip = p[H::slip];
  const double slip_work = value_or(p, H::slip_work, 0);
  if (slip_work > 0) out.slip *= 1 - std::exp(-work / slip_work);
  return out;
}

void HystereticStep::begin(const WornShape& shape, double z, double d) {
  shape_ = shape;
  z_ = z;
  d_ = d;
  up_.known = down_.known = false;
}

double HystereticStep::end(const LawValues& values, double d_now) {
  const double dy = values.p[H::dy];
  const double travel = (d_now - d_) / dy;
  if (travel == 0) return z_;
  const double most = std::max(shape_.most, std::abs(z_));
  if (values.form == LawForm::hysteresis && values.p[H::exponent] > kSharpCorner)
    return std::clamp(z_ + travel, -most, most);
  const Slope slope(values, shape_);
  const double direction = travel > 0 ? 1.0 : -1.0;
  const double longest = std::max(kLongestSlide, std::abs(travel) / kMaxSlides);
  double z = z_, at = d_ / dy;
  Begin& first = travel > 0 ? up_ : down_;
  if (!first.known) {
    first.rising = slope.without_slip(z, direction);
    first.slope = slope.slip(z, at, direction) * first.rising;
    first.known = true;
  }
  double rising = first.rising, at_start = first.slope;
  for (double left = std::abs(travel);;) {
    const bool loads = z * direction > 0;
    if (loads && rising * left < kYielded && rising > -kYielded) break;
    const double share = loads ? std::abs(slope.share(rising)) : 1;
    if (share < kNearlyYielded)
      return std::clamp(slope.at_end(z, at, direction, left, rising), -most, most);
    const double slide = share < kYields ? std::max(longest, kLongerSlide) : longest;
    const double h = direction * std::min(left, slide);
    z = std::clamp(z + h * slope(z + 0.5 * h * at_start, at + 0.5 * h, direction), -most, most);
    at += h;
    left -= slide;
    if (!(left > 0)) break;
    rising = slope.without_slip(z, direction);
    at_start = slope.slip(z, at, direction) * rising;
  }
  return z;
}

namespace {

enum Memory : std::size_t { kReversal_m, kReversalZ, kDirection, kLargest_m, kSmallest_m };

double direction_of(const std::vector<double>& memory, double d, double d_now) {
  return d_now > d ? 1.0 : d_now < d ? -1.0 : memory[kDirection];
}

}  // namespace

double spread_like(double sharpness) {
  return std::clamp(2.5 / sharpness, 0.05, 0.95);
}

std::vector<double> no_reversal(const LawValues& values) {
  const double dy = values.p[AsymptoteIndex::dy];
  return {0, 0, 0, dy, -dy};
}

void turn(std::vector<double>& memory, double z, double d, double d_now) {
  const double direction = direction_of(memory, d, d_now);
  if (direction == memory[kDirection]) return;
  if (memory[kDirection] != 0) {
    memory[kReversal_m] = d;
    memory[kReversalZ] = z;
    memory[kLargest_m] = std::max(memory[kLargest_m], d);
    memory[kSmallest_m] = std::min(memory[kSmallest_m], d);
  }
  memory[kDirection] = direction;
}

double asymptotic_z(const LawValues& values, const std::vector<double>& memory, double z, double d,
                    double d_now) {
  using A = AsymptoteIndex;
  constexpr double kHalf = 0.15, kMinSharpness = 0.3, kNoWay = 1e-9;
  std::vector<double> now = memory;
  turn(now, z, d, d_now);
  const double direction = now[kDirection], dy = values.p[A::dy];
  const double way = direction - now[kReversalZ];
  if (direction == 0 || std::abs(way) < kNoWay) return z;
  const double knee = now[kReversal_m] + way * dy;
  const double beyond = std::abs((direction > 0 ? now[kLargest_m] : now[kSmallest_m]) - knee) / dy;
  const double sharpness = std::max(
      values.p[A::sharpness] * (1 - values.p[A::loss] * beyond / (kHalf + beyond)), kMinSharpness);
  const double x = std::max((d_now - now[kReversal_m]) / (way * dy), 0.0);
  return now[kReversalZ] + way * bent(x, sharpness);
}

double PeakOriented::unloading_slope(const Side& side) const {
  return side.peak > 1 && unloading_ > 0 ? std::pow(side.peak, -unloading_) : 1;
}

double PeakOriented::at(double x) const {
  if (x == x_) return z_;
  const double direction = x > x_ ? 1.0 : -1.0, to = direction * x;
  const Side &ahead = side(direction), &behind = side(-direction);
  double from = direction * x_, z = direction * z_;
  if (z < 0) {
    const double slope = unloading_slope(behind), zero = from - z / slope;
    if (to <= zero) return direction * (z + slope * (to - from));
    from = zero;
    z = 0;
  } else if (ahead.turned && from < ahead.x) {
    if (to <= ahead.x) return direction * (z + unloading_slope(ahead) * (to - from));
    from = ahead.x;
    z = ahead.z;
  }
  if (to >= ahead.peak) return direction;
  return direction * (z + (1 - z) * (to - from) / (ahead.peak - from));
}

void PeakOriented::move(double x) {
  if (x == x_) return;
  const double direction = x > x_ ? 1.0 : -1.0, now = at(x);
  if (Side& left = side(-direction); !left.turned || -direction * x_ >= left.x)
    left = {left.peak, true, -direction * x_, -direction * z_};
  for (const double to : {1.0, -1.0}) {
    Side& of = side(to);
    of.turned = of.turned && to * now > 0 && to * x < of.x;
    of.peak = std::max(of.peak, to * x);
  }
  x_ = x;
  z_ = now;
}

double slider_force(const LawValues& values, const std::vector<double>& at, double d, double work) {
  const double weaker = weaker_of(values, work);
  double sum = 0;
  for (std::size_t i = 0; i < at.size(); ++i)
    sum += spring_stretch(values, d - at[i], limit_of(values, i, weaker));
  return sum / S::kCount;
}

void move_sliders(const LawValues& values, std::vector<double>& at, double d, double work) {
  const double weaker = weaker_of(values, work);
  for (std::size_t i = 0; i < at.size(); ++i)
    at[i] = d - spring_stretch(values, d - at[i], limit_of(values, i, weaker));
}

}  // namespace framewatch::estimator
