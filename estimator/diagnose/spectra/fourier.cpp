// SPDX-License-Identifier: MIT
#include "estimator/diagnose/spectra/fourier.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <unsupported/Eigen/FFT>

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr Index kFewest = 8;  ///< frequencies that determine a delay

VectorXd tapered(const VectorXd& signal, Index size) {
  const VectorXd phase = VectorXd::LinSpaced(size, 0, 2 * M_PI);
  const VectorXd part = signal.head(size).array() - signal.head(size).mean();
  return part.array() * (1 - phase.array().cos());
}

constexpr std::size_t kMaxSizes = 16;

/// Transforms between a real signal and half of its spectrum. Caches the twiddle factors of recent
/// sizes because computing them takes longer than a transform.
class Transforms {
 public:
  Transforms() { transform_.SetFlag(Eigen::FFT<double>::HalfSpectrum); }

  Eigen::FFT<double>& of(Index size) {
    if (std::find(sizes_.begin(), sizes_.end(), size) != sizes_.end()) return transform_;
    if (sizes_.size() == kMaxSizes) {
      transform_.impl().clear();
      sizes_.clear();
    }
    sizes_.push_back(size);
    return transform_;
  }

 private:
  Eigen::FFT<double> transform_;
  std::vector<Index> sizes_;
};

Eigen::FFT<double>& transform_of(Index size) {
  static thread_local Transforms all;
  return all.of(size);
}

}  // namespace

VectorXcd forward_fourier(const VectorXd& signal) {
  VectorXcd out(signal.size() / 2 + 1);
  transform_of(signal.size()).fwd(out.data(), signal.data(), signal.size());
  return out;
}

VectorXd inverse_fourier(const VectorXcd& half, Index size) {
  VectorXcd in = VectorXcd::Zero(size / 2 + 1);
  const Index given = std::min(half.size(), in.size());
  in.head(given) = half.head(given);
  VectorXd out(size);
  transform_of(size).inv(out.data(), in.data(), size);
  return out;
}

Index smooth_size(Index size) {
  for (; size > 1; --size) {
    Index rest = size;
    for (const Index factor : {2, 3, 5})
      while (rest % factor == 0) rest /= factor;
    if (rest == 1) break;
  }
  return size;
}

constexpr int kSincHalf = 12;  ///< taps on either side

VectorXd upsampled(const VectorXd& signal, int ratio, double shift) {
  if (ratio == 1 && shift == 0) return signal;
  const Index size = signal.size();
  VectorXd out = VectorXd::Zero(size * ratio);
  for (int phase = 0; phase < ratio; ++phase) {
    const double at = static_cast<double>(phase) / ratio - shift;
    const auto whole = static_cast<Index>(std::floor(at));
    std::vector<double> taps;
    double sum = 0;
    for (int k = -kSincHalf + 1; k <= kSincHalf; ++k) {
      const double x = k - (at - static_cast<double>(whole));
      const double sinc = std::abs(x) < 1e-12 ? 1.0 : std::sin(M_PI * x) / (M_PI * x);
      const double taper_at = x / (kSincHalf + 0.5);
      const double taper =
          0.42 + 0.5 * std::cos(M_PI * taper_at) + 0.08 * std::cos(2 * M_PI * taper_at);
      taps.push_back(sinc * taper);
      sum += taps.back();
    }
    for (double& tap : taps) tap /= sum;
    for (Index i = 0; i < size; ++i) {
      double value = 0;
      for (int k = -kSincHalf + 1; k <= kSincHalf; ++k) {
        const Index from = std::clamp<Index>(i + whole + k, 0, size - 1);
        value += taps[static_cast<std::size_t>(k + kSincHalf - 1)] * signal[from];
      }
      out[i * ratio + phase] = value;
    }
  }
  return out;
}

Delay delay_between(const VectorXd& first, const VectorXd& second, double rate_hz,
                    const Band& band) {
  const Index size = smooth_size(std::min(first.size(), second.size()));
  if (size < 2 * kFewest) return {};
  const double step_hz = rate_hz / static_cast<double>(size);
  const auto low = std::max<Index>(1, std::lround(band.low_hz / step_hz));
  const auto high = std::min<Index>(size / 2, std::lround(band.high_hz / step_hz));
  if (high - low + 1 < kFewest) return {};
  const VectorXcd a = forward_fourier(tapered(first, size)).segment(low, high - low + 1);
  const VectorXcd b = forward_fourier(tapered(second, size)).segment(low, high - low + 1);
  VectorXcd cross = VectorXcd::Zero(size / 2 + 1);
  cross.segment(low, high - low + 1) = a.conjugate().cwiseProduct(b);
  const double power = std::sqrt(a.squaredNorm() * b.squaredNorm());
  if (power <= 0) return {};
  const VectorXd correlation =
      inverse_fourier(cross, size) * (static_cast<double>(size) / (2 * power));
  Index at = 0;
  Delay out;
  out.likeness = correlation.cwiseAbs().maxCoeff(&at);
  out.undelayed = std::abs(correlation[0]);
  out.seconds = static_cast<double>(at < size / 2 ? at : at - size) / rate_hz;
  return out;
}

}  // namespace framewatch::estimator
