// SPDX-License-Identifier: MIT
#include "drivers/can/resampler.h"

#include <algorithm>
#include <cmath>

namespace framewatch::drivers {
namespace {

constexpr double kKaiser = 8.4;  // images 85 dB down with 10 taps for signals up to 0.2 of the rate

double bessel_i0(double x) {
  double sum = 1, term = 1;
  for (int k = 1; k < 30; ++k) {
    term *= (x / (2 * k)) * (x / (2 * k));
    sum += term;
  }
  return sum;
}

double weight(double distance, double half) {
  const double share = distance / half;
  if (std::abs(share) >= 1) return 0;
  static const double kNorm = bessel_i0(kKaiser);
  const double window = bessel_i0(kKaiser * std::sqrt(1 - share * share)) / kNorm;
  const double angle = M_PI * distance;
  return std::abs(distance) < 1e-12 ? 1 : window * std::sin(angle) / angle;
}

}  // namespace

bool Resampler::has(std::int64_t number) {
  return number >= 0 && slot(number).number == number && std::isfinite(slot(number).value);
}

/// Fills a sample by the cubic through two neighbors on each side. Returns false when one of them
/// is missing or was filled.
bool Resampler::fill(std::int64_t number) {
  for (const std::int64_t n : {number - 2, number - 1, number + 1, number + 2})
    if (!has(n) || slot(n).filled) return false;
  Slot& s = slot(number);
  s.value = (4 * (slot(number - 1).value + slot(number + 1).value) - slot(number - 2).value -
             slot(number + 2).value) /
            6;
  s.time_us = (slot(number - 1).time_us + slot(number + 1).time_us) / 2;
  s.number = number;
  s.filled = true;
  ++repaired_;
  return true;
}

bool Resampler::value_at(std::int64_t center, double fraction, double& value) {
  double sum = 0, norm = 0;
  for (std::int64_t n = center - kHalf + 1; n <= center + kHalf; ++n) {
    if (!has(n) && !fill(n)) return false;
    const double w = weight(static_cast<double>(n - center) - fraction, kHalf);
    sum += w * slot(n).value;
    norm += w;
  }
  value = sum / norm;
  return true;
}

void Resampler::add(std::int64_t number, double time_us, double period_us, double value,
                    const Sink& sink) {
  if (number < 0) return;
  const auto first_after = [&](double t) {
    return static_cast<std::int64_t>(std::ceil(t / grid_us_));
  };
  constexpr auto kKept = static_cast<std::int64_t>(kRing) - 2 * kHalf;
  if (!started_ || number > newest_ + kKept) {
    next_ = std::max(started_ ? next_ : INT64_MIN,
                     first_after(time_us + static_cast<double>(kHalf - 1) * period_us));
    started_ = true;
    newest_ = number;
  }
  if (number < newest_ - kKept) return;
  slot(number) = {number, time_us, value, false};
  newest_ = std::max(newest_, number);
  for (;; ++next_) {
    const double wanted_us = static_cast<double>(next_) * grid_us_;
    double position = static_cast<double>(number) + (wanted_us - time_us) / period_us;
    auto center = static_cast<std::int64_t>(std::floor(position));
    if (center + kHalf > newest_) return;
    if (center < newest_ - kKept) {  // skip to the first instant whose samples are kept
      const double behind = static_cast<double>(newest_ - kKept - center - 1) * period_us;
      next_ += static_cast<std::int64_t>(std::max(0.0, behind / grid_us_ - 1));
      continue;
    }
    // The time of a sample near the instant is more exact than extrapolation from the newest one.
    if (has(center))
      position = static_cast<double>(center) + (wanted_us - slot(center).time_us) / period_us;
    const double fraction = std::clamp(position - static_cast<double>(center), -0.5, 1.5);
    double result = 0;
    if (value_at(center, fraction, result))
      sink(std::llround(wanted_us), result);
    else if (newest_ < center + kHalf + kPatience)
      return;
  }
}

}  // namespace framewatch::drivers
