// SPDX-License-Identifier: MIT
#include "estimator/simulate/random.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace framewatch::estimator {
namespace {

/// SplitMix64's finalizer: neighboring inputs give unrelated outputs.
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

}  // namespace

Random::Random(std::uint64_t seed, std::uint64_t stream) : engine_(mixed(mixed(seed) ^ stream)) {}

double Random::uniform() {
  return static_cast<double>(engine_() >> 11) * 0x1p-53;
}

double Random::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  const double radius = std::sqrt(-2 * std::log(1 - uniform()));
  const double angle = 2 * M_PI * uniform();
  spare_ = radius * std::sin(angle);
  has_spare_ = true;
  return radius * std::cos(angle);
}

Eigen::VectorXd band_noise(Eigen::Index rows, double rate_hz, double low_hz, double high_hz,
                           Random& random) {
  Eigen::VectorXd cosine(rows), sine(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(rows);
    cosine[i] = std::cos(angle);
    sine[i] = std::sin(angle);
  }
  const double spacing_hz = rate_hz / static_cast<double>(rows);
  const auto first = std::max<Eigen::Index>(1, std::llround(std::ceil(low_hz / spacing_hz)));
  const auto last =
      std::min<Eigen::Index>((rows - 1) / 2, std::llround(std::floor(high_hz / spacing_hz)));
  assert(first <= last);
  Eigen::VectorXd out = Eigen::VectorXd::Zero(rows);
  for (Eigen::Index harmonic = first; harmonic <= last; ++harmonic) {
    const double in_phase = random.normal(), quadrature = random.normal();
    Eigen::Index at = 0;
    for (Eigen::Index i = 0; i < rows; ++i, at = (at + harmonic) % rows)
      out[i] += in_phase * cosine[at] + quadrature * sine[at];
  }
  return out / std::sqrt(out.squaredNorm() / static_cast<double>(rows));
}

}  // namespace framewatch::estimator
