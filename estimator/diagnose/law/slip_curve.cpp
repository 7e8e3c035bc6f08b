#include "estimator/diagnose/law/slip_curve.h"

#include <cmath>

namespace framewatch::estimator {

SlipCurve::End SlipCurve::follow(double x) const {
  if (x == now_.x) return {reversals_.size(), now_.z};
  const double direction = x > now_.x ? 1.0 : -1.0;
  const bool turns = direction == -direction_;
  const auto reversal = [&](std::size_t i) { return i < reversals_.size() ? reversals_[i] : now_; };
  std::size_t open = reversals_.size() + (turns ? 1 : 0);
  while (open > 0) {
    const Point from = reversal(open - 1);
    const double closes_at = open > 1 ? reversal(open - 2).x : -from.x;
    if ((x - closes_at) * direction <= 0)
      return {open, from.z + 2 * direction * std::pow(0.5 * std::abs(x - from.x), exponent_)};
    open = open > 1 ? open - 2 : 0;
  }
  return {0, std::copysign(std::pow(std::abs(x), exponent_), x)};
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

}  // namespace framewatch::estimator
