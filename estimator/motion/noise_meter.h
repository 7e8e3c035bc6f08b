#pragma once

#include <vector>

namespace framewatch::estimator {

/// Measures the noise of the axes in a band where a building hardly moves, 0.29 to 0.45 of the
/// sampling rate, over the last 5 s. docs/equations.md, measured noise.
class NoiseMeter {
 public:
  NoiseMeter(int axes, double rate_hz);

  /// One calibrated sample per axis; NaN starts that axis' filter anew.
  void push(const std::vector<double>& accel);
  /// One-sided density, m/s^2/sqrt(Hz); 0 before a second has been measured.
  double density(int axis) const;

  template <typename Archive>
  void archive(Archive& a) {
    a(axis_, ring_, newest_, since_output_);
  }

 private:
  struct Axis {
    int filled = 0;
    long measured = 0;
    double power = 0;

    template <typename Archive>
    void archive(Archive& a) {
      a(filled, measured, power);
    }
  };
  double rate_hz_;
  long least_, memory_;  ///< filter outputs
  std::vector<double> taps_;
  double gain_ = 0;  ///< sum of the taps' squares
  std::vector<Axis> axis_;
  std::vector<double> ring_;  ///< axes x twice the taps: the newest taps_.size() are contiguous
  std::size_t newest_ = 0;
  int since_output_ = 0;
};

}  // namespace framewatch::estimator
