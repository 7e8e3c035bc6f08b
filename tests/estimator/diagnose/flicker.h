// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "tests/estimator/diagnose/small_building.h"

namespace framewatch::test {

/// Returns 1/f noise that equals the believed white noise at corner_hz: a sum of low-pass noises
/// whose corners differ by factors of four.
inline Eigen::VectorXd flicker(Eigen::Index samples, double corner_hz, std::uint64_t seed) {
  constexpr int kParts = 7;
  constexpr double kStep = 4;
  estimator::Random random(seed);
  Eigen::VectorXd out = Eigen::VectorXd::Zero(samples);
  // A part of unit power at f0 has the density 2 f0 / (pi (f^2 + f0^2)). The sum over factors of
  // four is about 1 / (f ln 4).
  const double power = 2 * corner_hz * std::log(kStep) / kRate_hz;
  double f0 = 0.25 * kRate_hz;
  for (int part = 0; part < kParts; ++part, f0 /= kStep) {
    const double keep = std::exp(-2 * M_PI * f0 / kRate_hz);
    double now = random.normal();
    for (double& value : out) {
      value += kNoise_mps2 * std::sqrt(power) * now;
      now = keep * now + std::sqrt(1 - keep * keep) * random.normal();
    }
  }
  return out;
}

inline std::vector<Eigen::MatrixXd> with_flicker(std::vector<Eigen::MatrixXd> records,
                                                 double corner_hz) {
  std::uint64_t seed = 50;
  for (Eigen::MatrixXd& record : records)
    for (Eigen::Index a = 0; a < record.cols(); ++a)
      record.col(a) += flicker(record.rows(), corner_hz, ++seed);
  return records;
}

}  // namespace framewatch::test
