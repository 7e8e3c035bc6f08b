#include "estimator/motion/noise_meter.h"

#include <algorithm>
#include <cmath>

namespace framewatch {
namespace {

constexpr int kTaps = 41;
constexpr int kEvery = 4;  // samples per filter output: the band's noise does not need more
constexpr double kLow = 0.28,
                 kHigh = 0.45;  // of the sampling rate; half the window's transition in
constexpr double kMemory_s = 5;
constexpr double kLeast_s = 1;

}  // namespace

NoiseMeter::NoiseMeter(int axes, double rate_hz)
    : rate_hz_(rate_hz),
      least_(std::max(4L, std::lround(kLeast_s * rate_hz / kEvery))),
      memory_(std::max(least_, std::lround(kMemory_s * rate_hz / kEvery))),
      axis_(static_cast<std::size_t>(axes)),
      ring_(static_cast<std::size_t>(axes) * 2 * kTaps, 0.0) {
  for (int i = 0; i < kTaps; ++i) {
    const double k = i - (kTaps - 1) / 2;
    const double ideal =
        k == 0 ? 2 * (kHigh - kLow)
               : (std::sin(2 * M_PI * kHigh * k) - std::sin(2 * M_PI * kLow * k)) / (M_PI * k);
    const double hamming = 0.54 - 0.46 * std::cos(2 * M_PI * i / (kTaps - 1));
    taps_.push_back(ideal * hamming);
    gain_ += taps_.back() * taps_.back();
  }
}

void NoiseMeter::push(const std::vector<double>& accel) {
  newest_ = newest_ == 0 ? kTaps - 1 : newest_ - 1;
  since_output_ = (since_output_ + 1) % kEvery;
  for (std::size_t a = 0; a < axis_.size(); ++a) {
    Axis& axis = axis_[a];
    double* ring = &ring_[a * 2 * kTaps];
    const bool valid = std::isfinite(accel[a]);
    ring[newest_] = ring[newest_ + kTaps] = valid ? accel[a] : 0;
    axis.filled = valid ? std::min(axis.filled + 1, kTaps) : 0;
    if (since_output_ != 0 || axis.filled < kTaps) continue;
    double sum = 0;
    for (std::size_t i = 0; i < kTaps; ++i) sum += taps_[i] * ring[newest_ + i];
    axis.measured = std::min(axis.measured + 1, memory_);
    axis.power += (sum * sum - axis.power) / static_cast<double>(axis.measured);
  }
}

double NoiseMeter::density(int axis) const {
  const Axis& a = axis_[static_cast<std::size_t>(axis)];
  return a.measured < least_ ? 0 : std::sqrt(2 * a.power / (gain_ * rate_hz_));
}

}  // namespace framewatch
