// SPDX-License-Identifier: MIT
#include "estimator/motion/noise_meter.h"

#include <algorithm>
#include <cmath>

namespace framewatch::estimator {
namespace {

constexpr int kTaps = 61;
constexpr int kEvery = 4;  // samples per filter output; the band's noise needs no more
constexpr double kLow = 0.28, kHigh = 0.45;  // of the sampling rate, with half the transition
constexpr double kNoiseMemory_s = 5;
constexpr double kLeast_s = 1;

double blackman(int tap) {
  const double phase = 2 * M_PI * tap / (kTaps - 1);
  return 0.42 - 0.5 * std::cos(phase) + 0.08 * std::cos(2 * phase);
}

}  // namespace

NoiseMeter::NoiseMeter(int axes, double rate_hz)
    : rate_hz_(rate_hz),
      least_(std::max(4L, std::lround(kLeast_s * rate_hz / kEvery))),
      memory_(std::max(least_, std::lround(kNoiseMemory_s * rate_hz / kEvery))),
      lasts_(std::lround(kLasts_s * rate_hz / kEvery)),
      axis_(static_cast<std::size_t>(axes)),
      ring_(static_cast<std::size_t>(axes) * 2 * kTaps, 0.0) {
  std::vector<double> window;
  double at_rest = 0, area = 0;
  for (int i = 0; i < kTaps; ++i) {
    const double k = i - (kTaps - 1) / 2;
    const double ideal =
        k == 0 ? 2 * (kHigh - kLow)
               : (std::sin(2 * M_PI * kHigh * k) - std::sin(2 * M_PI * kLow * k)) / (M_PI * k);
    window.push_back(blackman(i));
    taps_.push_back(ideal * window.back());
    at_rest += taps_.back();
    area += window.back();
  }
  // Makes the gain at rest exactly zero, because a sensor's bias is many times its noise.
  for (std::size_t i = 0; i < kTaps; ++i) {
    taps_[i] -= at_rest / area * window[i];
    gain_ += taps_[i] * taps_[i];
  }
}

void NoiseMeter::push(const std::vector<double>& accel) {
  newest_ = newest_ == 0 ? kTaps - 1 : newest_ - 1;
  since_output_ = (since_output_ + 1) % kEvery;
  for (std::size_t a = 0; a < axis_.size(); ++a) {
    Axis& axis = axis_[a];
    double* ring = &ring_[a * 2 * kTaps];
    const bool valid = std::isfinite(accel[a]);
    const bool same = valid && axis.filled > 0 && accel[a] == ring[newest_ + 1];
    axis.still = same ? std::min(axis.still + 1, kTaps) : 0;
    ring[newest_] = ring[newest_ + kTaps] = valid ? accel[a] : 0;
    axis.filled = valid ? std::min(axis.filled + 1, kTaps) : 0;
    if (since_output_ != 0 || axis.filled < kTaps || axis.still >= kTaps - 1) continue;
    double sum = 0;
    for (std::size_t i = 0; i < kTaps; ++i) sum += taps_[i] * ring[newest_ + i];
    if (axis.measured >= least_ && sum * sum > kBeyond * kBeyond * axis.power)
      axis.tainted = kTaps / kEvery + 1;
    const bool left_out = axis.tainted > 0;
    if (left_out) --axis.tainted;
    axis.beyond = left_out ? axis.beyond + 1 : 0;
    if (left_out && axis.beyond <= lasts_) continue;
    axis.measured = std::min(axis.measured + 1, memory_);
    axis.power += (sum * sum - axis.power) / static_cast<double>(axis.measured);
  }
}

void NoiseMeter::reset() {
  std::fill(axis_.begin(), axis_.end(), Axis{});
  std::fill(ring_.begin(), ring_.end(), 0.0);
  newest_ = 0;
  since_output_ = 0;
}

double NoiseMeter::density(int axis) const {
  const Axis& a = axis_[static_cast<std::size_t>(axis)];
  return a.measured < least_ ? 0 : std::sqrt(2 * a.power / (gain_ * rate_hz_));
}

}  // namespace framewatch::estimator
