#pragma once

#include <vector>

#include <Eigen/Core>

namespace framewatch {

/// Linear-phase low-pass (Kaiser-windowed sinc), unit gain at 0 Hz, odd length: passes up to 0.4 of
/// the output rate within 1e-4 and stops from 0.6 on by 80 dB; `ratio` fine steps per output step.
std::vector<double> anti_alias_taps(int ratio);

/// The same low-pass on every channel of a fine stream; its delay is delay_steps() fine steps.
class Decimator {
 public:
  /// Odd number of taps; {1} passes the stream through.
  Decimator(std::vector<double> taps, int channels);

  int delay_steps() const { return static_cast<int>(taps_.size() / 2); }
  void push(const Eigen::VectorXd& fine);
  /// Filtered channels as they were delay_steps() pushes before the newest.
  const Eigen::VectorXd& output();

 private:
  std::vector<double> taps_;
  Eigen::MatrixXd ring_;  ///< channels x taps
  int newest_ = 0;
  Eigen::VectorXd output_;
};

}  // namespace framewatch
