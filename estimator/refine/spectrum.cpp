// SPDX-License-Identifier: MIT
#include "estimator/refine/spectrum.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "estimator/structure/matrices.h"
#include "estimator/structure/natural_frequencies.h"

namespace framewatch::estimator {

Band structure_band(const Structure& structure, const ParameterTable& table,
                    const Eigen::VectorXd& theta, double rate_hz) {
  const std::vector<double> hz = natural_frequencies_hz(structure, table, theta);
  return {0.4 * hz.front(), std::min(0.4 * rate_hz, 3 * hz.back())};
}

Spectrum spectrum_of(const Eigen::MatrixXd& accel, const Eigen::VectorXd& delay, double rate_hz,
                     const Band& band) {
  Spectrum out;
  const Eigen::Index intervals = std::max<Eigen::Index>(accel.rows() - 1, 0);
  out.intervals = static_cast<double>(intervals);
  const double step_hz = rate_hz / std::max(out.intervals, 1.0);
  const auto first = std::max<Eigen::Index>(1, std::llround(std::ceil(band.low_hz / step_hz)));
  const auto last =
      std::min<Eigen::Index>((intervals - 1) / 2, std::llround(std::floor(band.high_hz / step_hz)));
  const Eigen::Index bins = std::max<Eigen::Index>(0, last - first + 1);
  out.w.resize(bins);
  out.accel.resize(accel.cols(), bins);
  if (bins == 0) return out;

  Eigen::MatrixXd periodic = accel.topRows(intervals);
  periodic.row(0) = 0.5 * (accel.row(0) + accel.row(intervals));
  Eigen::VectorXcd turn(intervals);
  for (Eigen::Index b = 0; b < bins; ++b) {
    const Eigen::Index k = first + b;
    const double angle = 2 * M_PI / out.intervals;
    out.w[b] = angle * static_cast<double>(k) * rate_hz;
    for (Eigen::Index i = 0; i < intervals; ++i)
      turn[i] = std::polar(1.0, -angle * static_cast<double>((k * i) % intervals));
    out.accel.col(b).real() = periodic.transpose() * turn.real();
    out.accel.col(b).imag() = periodic.transpose() * turn.imag();
    for (Eigen::Index a = 0; a < accel.cols(); ++a)
      out.accel(a, b) *= std::polar(1.0, out.w[b] * delay[a]);
  }
  out.band = {out.w[0] / (2 * M_PI), out.w[bins - 1] / (2 * M_PI)};
  return out;
}

}  // namespace framewatch::estimator
