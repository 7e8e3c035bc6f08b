#include "estimator/simulate/band_noise.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace framewatch::estimator {

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
