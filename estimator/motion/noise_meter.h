// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace framewatch::estimator {

/// Measures the noise of the axes over the last 5 s, in a band where a building hardly moves: 0.29
/// to 0.45 of the sampling rate. An output kBeyond times as large is not noise and is left out,
/// with all outputs whose filter holds it, unless it lasts for kLasts_s. A filter full of equal
/// values is left out too: zeros around a record, or a resolution coarser than the noise.
/// docs/equations.md, measured noise.
class NoiseMeter {
 public:
  static constexpr double kBeyond = 6, kLasts_s = 2;

  NoiseMeter(int axes, double rate_hz);

  /// Takes one calibrated sample per axis. NaN restarts the filter of that axis.
  void push(const std::vector<double>& accel);
  /// Returns the one-sided density, m/s^2/sqrt(Hz); 0 before one second has been measured.
  double density(int axis) const;
  /// Discards all measurements.
  void reset();

  void archive(auto& a) {
    a(axis_);
    a.finite(ring_);
    a.within(newest_, 0, static_cast<double>(taps_.size() - 1));
    a.within(since_output_, 0, 1000);
  }

 private:
  struct Axis {
    int filled = 0;
    int still = 0;  ///< equal values in the filter after the first of them
    long measured = 0;
    long beyond = 0;  ///< outputs left out in a row
    int tainted = 0;  ///< coming outputs whose filter holds an excluded value
    double power = 0;

    void archive(auto& a) {
      for (long* number : {&measured, &beyond}) a.within(*number, 0, a.kMaxCount);
      for (int* number : {&filled, &still}) a.within(*number, 0, 1000);
      a.within(tainted, 0, 1000);
      a.within(power, 0, a.kMax);
    }
  };
  double rate_hz_;
  long least_, memory_, lasts_;  ///< filter outputs
  std::vector<double> taps_;
  double gain_ = 0;  ///< sum of the taps' squares
  std::vector<Axis> axis_;
  std::vector<double> ring_;  ///< axes x twice the taps: the newest taps_.size() are contiguous
  std::size_t newest_ = 0;
  int since_output_ = 0;
};

}  // namespace framewatch::estimator
