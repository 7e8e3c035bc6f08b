// SPDX-License-Identifier: MIT
#include "estimator/diagnose/law/law.h"

#include <algorithm>
#include <cmath>

#include "estimator/diagnose/law/hysteretic_force.h"

namespace framewatch::estimator {
namespace {

using A = AmplitudeIndex;
using I = FrictionIndex;

constexpr double kAtRest = 1e-6;  // of v0

/// Returns the rate, 1/s, at which z approaches its steady value.
double approach_per_s(const std::vector<double>& p, double v) {
  if (std::abs(v) < kAtRest * p[I::v0])
    return p[I::v0] / ((1 + value_or(p, I::static_ratio, 0)) * p[I::presliding]);
  return std::abs(v / steady_friction(p, v)) / p[I::presliding];
}

double signed_power(double x, double p) {
  return std::copysign(power_of(std::abs(x), p), x);
}

/// Force of a contact toward positive deformation. It only pushes if its spring hardens.
double contact(const std::vector<double>& p, double d, double v) {
  if (d <= p[1]) return 0;
  const double force = p[0] * (d - p[1]) + value_or(p, 2, 0) * v;
  return p[0] >= 0 ? std::max(force, 0.0) : force;
}

bool preslides(const LawValues& values) {
  return values.form == LawForm::friction && value_or(values.p, FrictionIndex::presliding, 0) > 0;
}

/// Returns z/dy of LawForm::masing at x = d/dy: x less the softening that slips.
double masing_z(const std::vector<double>& p, const SlipCurve& slip, double x) {
  return x - (1 - bent(1, p[MasingIndex::sharpness])) * slip.at(x);
}

/// Returns true if z follows a rate equation.
bool has_z(LawForm form) {
  return form == LawForm::hysteresis || form == LawForm::pinched || form == LawForm::slip_lock;
}

}  // namespace

Softening::Softening(double exponent, double saturation)
    : exponent_(exponent), saturation_(saturation) {
  if (saturation > 0) size_ = 1 / at(1);
}

double Softening::at(double x) const {
  if (!(saturation_ > 0)) return signed_power(x, exponent_);
  const double left = saturation_ * bent(std::abs(x) / saturation_, exponent_ - 1);
  return size_ * std::copysign(std::abs(x) - left, x);
}

SlipCurve::End SlipCurve::follow(double x) const {
  if (x == now_.x) return {reversals_.size(), now_.z};
  const double direction = x > now_.x ? 1.0 : -1.0;
  const bool turns = direction == -direction_;
  const auto reversal = [&](std::size_t i) { return i < reversals_.size() ? reversals_[i] : now_; };
  std::size_t open = reversals_.size() + (turns ? 1 : 0);
  while (open > 0) {
    const Point from = reversal(open - 1);
    const double closes_at = open > 1 ? reversal(open - 2).x : -from.x;
    if ((x - closes_at) * direction <= 0) return {open, from.z + 2 * first_.at(0.5 * (x - from.x))};
    open = open > 1 ? open - 2 : 0;
  }
  return {0, first_.at(x)};
}

void SlipCurve::move(double x) {
  if (x == now_.x) return;
  const End end = follow(x);
  if (end.open > reversals_.size())
    reversals_.push_back(now_);
  else
    reversals_.resize(end.open, now_);
  direction_ = x > now_.x ? 1.0 : -1.0;
  now_ = {x, end.z};
}

double steady_friction(const std::vector<double>& p, double v) {
  double more = value_or(p, I::static_ratio, 0);
  if (more != 0) more *= std::exp(-(v / p[I::stribeck]) * (v / p[I::stribeck]));
  return (1 + more) * std::tanh(v / p[I::v0]);
}

/// Exact for a steady value that changes linearly and a constant rate of approach.
double sliding_z(const std::vector<double>& p, double z, double v, double v_now, double step_s) {
  const double from = steady_friction(p, v), to = steady_friction(p, v_now);
  const double passed = 0.5 * (approach_per_s(p, v) + approach_per_s(p, v_now)) * step_s;
  if (!(passed > 0)) return z;
  const double left = std::exp(-passed);
  return to - (to - from) * (1 - left) / passed + (z - from) * left;
}

std::vector<double> first_slack(const std::vector<double>& p) {
  return {p[SlackIndex::play], p[SlackIndex::play]};
}

double slack_force(const std::vector<double>& p, const std::vector<double>& slack, double d) {
  return std::clamp(d - slack[0], 0.0, p[SlackIndex::dy]) -
         std::clamp(-d - slack[1], 0.0, p[SlackIndex::dy]);
}

void slacken(const std::vector<double>& p, std::vector<double>& slack, double d) {
  slack[0] = std::max(slack[0], d - p[SlackIndex::dy]);
  slack[1] = std::max(slack[1], -d - p[SlackIndex::dy]);
}

bool is_element_law(LawForm form) {
  return form <= LawForm::changing;
}

bool is_hysteretic(LawForm form) {
  return form >= LawForm::hysteresis && form <= LawForm::peak_oriented;
}

bool is_contact(LawForm form) {
  return form >= LawForm::gap_positive && form <= LawForm::gap_both;
}

LawMotion::LawMotion(const LawValues& values) : values_(values) {
  if (values.form == LawForm::sliders) memory_.assign(SliderIndex::kCount, 0.0);
  if (values.form == LawForm::asymptotic) memory_ = no_reversal(values);
  if (values.form == LawForm::slack) memory_ = first_slack(values.p);
  if (values.form == LawForm::saturating)
    softening_.emplace(values.p[SaturationIndex::shape] + 1,
                       values.p[SaturationIndex::d0] / values.deformation);
  if (values.form == LawForm::masing) {
    slip_.emplace(Softening(values.p[MasingIndex::sharpness] + 1, 1));
    slip_unit_m_ = values.p[MasingIndex::dy];
  }
  if (values.form == LawForm::peak_oriented) peaks_.emplace(values.p[PeakIndex::unloading]);
  if (values.form == LawForm::amplitude) {
    slip_unit_m_ = values.deformation;
    softening_.emplace(values.p[A::exponent], value_or(values.p, A::saturation, 0));
    if (value_or(values.p, A::slip, 0) > 0) slip_.emplace(*softening_);
  }
  if (!has_z(values.form)) return;
  shape_ = worn_shape(values, 0);
  const WornShape later = worn_shape(values, 1);
  wears_ = later.weaker != 1 || later.softer != 1 || later.slip != shape_.slip;
  step_.begin(shape_, 0, 0);
}

double LawMotion::force(double d, double v, double t) {
  return values_.scale * plain_force(d, v, t);
}

double LawMotion::next_z(double d) {
  if (has_next_ && d == next_d_) return next_z_;
  has_next_ = true;
  next_d_ = d;
  return next_z_ = step_.end(values_, d);
}

double LawMotion::amplitude_z(double x) const {
  const double slips = value_or(values_.p, A::slip, 0);
  const double slip = slips > 0 ? slips * slip_->at(x) : 0;
  return slips < 1 ? slip + (1 - slips) * softening_->at(x) : slip;
}

double LawMotion::plain_force(double d, double v, double t) {
  const std::vector<double>& p = values_.p;
  switch (values_.form) {
    case LawForm::power:
      return p[0] * signed_power(d / values_.deformation, p[1]);
    case LawForm::saturating:
      return p[SaturationIndex::force] * softening_->at(d / values_.deformation);
    case LawForm::hysteresis:
    case LawForm::pinched:
    case LawForm::slip_lock:
      return p[0] * p[1] * next_z(d);
    case LawForm::sliders:
      return p[0] * slider_force(values_, memory_, d, work_);
    case LawForm::asymptotic:
      return p[0] * p[1] * asymptotic_z(values_, memory_, z_, d_, d);
    case LawForm::masing:
      return p[0] * p[1] * masing_z(p, *slip_, d / p[1]);
    case LawForm::peak_oriented:
      return p[0] * p[1] * peaks_->at(d / p[1]);
    case LawForm::slack:
      return p[0] * slack_force(p, memory_, d);
    case LawForm::friction:
      return p[0] * (preslides(values_) ? sliding_z(p, z_, v_, v, t - t_) : steady_friction(p, v));
    case LawForm::power_damping:
      return p[0] * signed_power(v / values_.rate, p[1]);
    case LawForm::amplitude:
      return p[A::elastic] * amplitude_z(d / values_.deformation) +
             p[A::damping] * signed_power(v / values_.rate, p[A::damping_exponent]);
    case LawForm::gap_positive:
      return contact(p, d, v);
    case LawForm::gap_negative:
      return -contact(p, -d, -v);
    case LawForm::gap_both:
      return contact(p, d, v) - contact(p, -d, -v);
    case LawForm::changing:
      return p[0] * std::clamp((t - p[1]) / p[2], 0.0, 1.0) * d;
    default:
      return 0;
  }
}

void LawMotion::accept(double d, double v, double t) {
  if (preslides(values_)) z_ = sliding_z(values_.p, z_, v_, v, t - t_);
  if (slip_) slip_->move(d / slip_unit_m_);
  if (peaks_) peaks_->move(d / values_.p[PeakIndex::dy]);
  if (is_hysteretic(values_.form) && !slip_ && !peaks_) {
    const double dy = values_.p[HysteresisIndex::dy];
    if (values_.form == LawForm::sliders) {
      const double force = slider_force(values_, memory_, d, work_) / dy;
      work_ += 0.5 * (z_ + force) * (d - d_) / dy;
      move_sliders(values_, memory_, d, work_);
      z_ = force;
    } else if (values_.form == LawForm::asymptotic) {
      const double z = asymptotic_z(values_, memory_, z_, d_, d);
      turn(memory_, z_, d_, d);
      z_ = z;
    } else if (values_.form == LawForm::slack) {
      slacken(values_.p, memory_, d);
    } else {
      const double z = next_z(d);
      work_ += 0.5 * (z_ + z) * (d - d_) / dy;
      z_ = z;
    }
    work_ = std::max(work_, 0.0);
  }
  has_next_ = false;
  d_ = d;
  v_ = v;
  t_ = t;
  if (!has_z(values_.form)) return;
  if (wears_) shape_ = worn_shape(values_, work_);
  step_.begin(shape_, z_, d_);
}

Eigen::VectorXd law_force(const LawValues& values, const Eigen::VectorXd& d,
                          const Eigen::VectorXd& v, double step_s) {
  LawMotion motion(values);
  Eigen::VectorXd out(d.size());
  for (Eigen::Index i = 0; i < d.size(); ++i) {
    const double t = step_s * static_cast<double>(i);
    out[i] = motion.force(d[i], v[i], t);
    motion.accept(d[i], v[i], t);
  }
  return out;
}

}  // namespace framewatch::estimator
