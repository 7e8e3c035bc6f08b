#include "estimator/diagnose/model/law.h"

#include <algorithm>
#include <cmath>

namespace framewatch::estimator {
namespace {

constexpr double kSharp = 20;          ///< exponent above which hysteresis is computed as bilinear
constexpr double kLongestSlide = 0.1;  ///< of z per integration step, in units of dy
constexpr double kYielded = 1e-12;  ///< change of z below which the rest of a step changes nothing
constexpr double kMostSlides = 5000;

double power_of(double x, double p) {
  return p == 1 ? x : p == 2 ? x * x : p == 3 ? x * x * x : std::pow(x, p);
}

double signed_power(double x, double p) {
  return std::copysign(power_of(std::abs(x), p), x);
}

/// dz/dd of the normalised Bouc-Wen law.
double hysteresis_slope(double z, double direction, double n, double beta) {
  const double level = power_of(std::abs(z), n);
  return 1 - level * (beta * (z * direction > 0 ? 1.0 : -1.0) + 1 - beta);
}

}  // namespace

bool is_element_law(LawForm form) {
  return form <= LawForm::changing;
}

// p of hysteresis: kh, dy, n, beta; pinched: also slip ratio and slip width.
double LawMotion::advanced(double d) const {
  const double dy = values_.p[1], n = values_.p[2], beta = values_.p[3];
  const double travel = (d - d_) / dy;
  if (travel == 0) return z_;
  const bool pinched = values_.form == LawForm::pinched;
  if (n > kSharp && !pinched) return std::clamp(z_ + travel, -1.0, 1.0);
  const double direction = travel > 0 ? 1.0 : -1.0;
  const auto slope = [&](double z) {
    const double slip =
        pinched ? 1 - values_.p[4] * std::exp(-(z / values_.p[5]) * (z / values_.p[5])) : 1.0;
    return slip * hysteresis_slope(z, direction, n, beta);
  };
  const double longest = std::max(kLongestSlide, std::abs(travel) / kMostSlides);
  double z = z_;
  for (double left = std::abs(travel); left > 0; left -= longest) {
    const double at_start = slope(z);
    if (z * direction > 0 && at_start * left < kYielded) break;
    const double h = direction * std::min(left, longest);
    z = std::clamp(z + h * slope(z + 0.5 * h * at_start), -1.0, 1.0);
  }
  return z;
}

double LawMotion::force(double d, double v, double t) const {
  const std::vector<double>& p = values_.p;
  switch (values_.form) {
    case LawForm::power:
      return p[0] * signed_power(d / values_.deformation, p[1]);
    case LawForm::hysteresis:
    case LawForm::pinched:
      return p[0] * p[1] * advanced(d);
    case LawForm::friction:
      return p[0] * std::tanh(v / p[1]);
    case LawForm::power_damping:
      return p[0] * signed_power(v / values_.rate, p[1]);
    case LawForm::gap_positive:
      return p[0] * std::max(d - p[1], 0.0);
    case LawForm::gap_negative:
      return -p[0] * std::max(-d - p[1], 0.0);
    case LawForm::gap_both:
      return p[0] * (std::max(d - p[1], 0.0) - std::max(-d - p[1], 0.0));
    case LawForm::changing:
      return p[0] * std::clamp((t - p[1]) / p[2], 0.0, 1.0) * d;
    default:
      return 0;
  }
}

void LawMotion::accept(double d, double, double) {
  if (values_.form == LawForm::hysteresis || values_.form == LawForm::pinched) z_ = advanced(d);
  d_ = d;
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
