// SPDX-License-Identifier: MIT
#include "estimator/identify/noise/floor_noise.h"

#include <algorithm>

namespace framewatch::estimator {

FloorNoise floor_noise(const FloorLayout& layout, const Deformations& deformations,
                       const std::vector<double>& noise_density, double rate_hz, int floor) {
  const int frames = layout.frames();
  const int panels = layout.panels();
  const int own = layout.own();
  const int unknowns = own + layout.next(floor);
  FloorNoise out;
  const auto column = [&](int axis) {
    const auto found = std::find(out.axes.begin(), out.axes.end(), axis);
    if (found == out.axes.end()) out.axes.push_back(axis);
    return found - out.axes.begin();
  };
  const int levels = layout.next(floor) > 0 ? 3 : 2;
  for (int level = floor; level < floor + levels; ++level)
    for (int f = 0; f < frames; ++f)
      for (const auto& share : deformations.at(level, f)) column(share.axis);
  const auto axes = static_cast<Eigen::Index>(out.axes.size());
  out.motion = Eigen::MatrixXd::Zero(frames, axes);
  out.deformation = Eigen::MatrixXd::Zero(unknowns, axes);
  const auto add = [&](auto row, int level, int f, double coefficient) {
    for (const auto& [axis, weight] : deformations.at(level, f))
      row[column(axis)] += coefficient * weight;
  };
  for (int f = 0; f < frames; ++f) add(out.motion.row(f), floor + 1, f, 1);
  for (int p = 0; p < unknowns; ++p) {
    const bool of_next = p >= own;
    const int local = of_next ? p - own : p;
    if (of_next || local < 2 * frames) {
      const int upper = floor + (of_next ? 2 : 1);
      add(out.deformation.row(p), upper, local % frames, 1);
      add(out.deformation.row(p), upper - 1, local % frames, -1);
    } else {
      for (int f = 0; f < frames; ++f)
        if (layout.coefficient(p, f) != 0)
          add(out.deformation.row(p), floor + 1, f, layout.coefficient(p, f));
    }
    out.damping.push_back(of_next || local < 2 * frames ? local >= frames
                                                        : local - 2 * frames >= panels);
  }
  out.variance.resize(axes);
  out.covariance.resize(unknowns, unknowns);
  set_noise_density(out, noise_density, rate_hz);
  return out;
}

void set_noise_density(FloorNoise& noise, const std::vector<double>& density, double rate_hz) {
  for (Eigen::Index a = 0; a < noise.variance.size(); ++a)
    noise.variance[a] = noise_variance(
        density[static_cast<std::size_t>(noise.axes[static_cast<std::size_t>(a)])], rate_hz);
  for (Eigen::Index p = 0; p < noise.covariance.rows(); ++p) {
    for (Eigen::Index q = p; q < noise.covariance.cols(); ++q) {
      double sum = 0;
      for (Eigen::Index a = 0; a < noise.variance.size(); ++a)
        sum += noise.deformation(p, a) * noise.variance[a] * noise.deformation(q, a);
      noise.covariance(p, q) = noise.covariance(q, p) = sum;
    }
  }
}

std::vector<double> impulse_response(const std::vector<double>& taps, const HighPass& hp,
                                     std::size_t length) {
  std::vector<double> high(length), out(length, 0.0);
  double y1 = 0, y2 = 0;
  for (std::size_t t = 0; t < length; ++t) {
    const double change = t == 0 ? 1.0 : t == 1 ? -2.0 : t == 2 ? 1.0 : 0.0;
    const double y = hp.gain * change - hp.a1 * y1 - hp.a2 * y2;
    y2 = y1;
    y1 = y;
    high[t] = y;
  }
  for (std::size_t t = 0; t < length; ++t)
    for (std::size_t k = 0; k < taps.size() && k <= t; ++k) out[t] += taps[k] * high[t - k];
  return out;
}

NoiseFilter::NoiseFilter(const DerivativeTriple& triple, const HighPass& high_pass,
                         std::size_t length) {
  for (const std::vector<double>* taps : {&triple.value, &triple.first, &triple.second})
    impulse_.push_back(impulse_response(*taps, high_pass, length));
}

NoiseMoments NoiseFilter::through(const OscillatorSection& section) const {
  NoiseMoments noise;
  double s[3][2] = {};
  for (std::size_t t = 0; t < impulse_[0].size(); ++t) {
    double y[3];
    for (std::size_t d = 0; d < 3; ++d) {
      y[d] = section.gain * impulse_[d][t] - section.a1 * s[d][0] - section.a2 * s[d][1];
      s[d][1] = s[d][0];
      s[d][0] = y[d];
    }
    noise.g00 += y[0] * y[0];
    noise.g11 += y[1] * y[1];
    noise.g22 += y[2] * y[2];
    noise.g20 += y[2] * y[0];
  }
  return noise;
}

}  // namespace framewatch::estimator
