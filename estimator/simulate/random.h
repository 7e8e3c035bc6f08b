// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <random>

#include <Eigen/Core>

namespace framewatch::estimator {

/// Generates seeded normal and uniform numbers that, unlike those of the standard distributions,
/// are the same on every platform.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  /// Makes an independent generator for every (seed, stream).
  Random(std::uint64_t seed, std::uint64_t stream);

  /// Returns a number in [0, 1).
  double uniform();
  /// Returns a number of mean 0 and standard deviation 1 (Box-Muller).
  double normal();

 private:
  std::mt19937_64 engine_;
  double spare_ = 0;
  bool has_spare_ = false;
};

/// Returns `rows` samples of band-limited white noise of rms 1. Every harmonic of their length
/// between low_hz and high_hz has a random amplitude and phase. Precondition: a harmonic lies in
/// the band.
Eigen::VectorXd band_noise(Eigen::Index rows, double rate_hz, double low_hz, double high_hz,
                           Random& random);

}  // namespace framewatch::estimator
