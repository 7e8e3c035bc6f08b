#include "estimator/diagnose/spectra/delay.h"

#include <algorithm>
#include <cmath>

#include "estimator/diagnose/spectra/fourier.h"

namespace framewatch::estimator {

using Eigen::Index;
using Eigen::VectorXcd;
using Eigen::VectorXd;

namespace {

constexpr Index kFewest = 8;  ///< frequencies that determine a delay

VectorXd tapered(const VectorXd& signal, Index size) {
  const VectorXd phase = VectorXd::LinSpaced(size, 0, 2 * M_PI);
  const VectorXd part = signal.head(size).array() - signal.head(size).mean();
  return part.array() * (1 - phase.array().cos());
}

}  // namespace

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
