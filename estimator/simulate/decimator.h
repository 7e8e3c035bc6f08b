#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>

namespace framewatch::estimator {

/// Linear-phase low-pass (Kaiser-windowed sinc), unit gain at 0 Hz: passes up to 0.4 of the output
/// rate within 1e-4 and stops from 0.6 on by 80 dB; `ratio` fine steps per output step. An odd
/// number of taps, centred; what they give is late by `delay` fine steps, not necessarily whole.
std::vector<double> anti_alias_taps(int ratio, double delay = 0);

/// One output of a Decimator.
struct DecimatorChannel {
  int column;                ///< of the fine stream
  std::vector<double> taps;  ///< odd number, centred; {1} passes the stream through
  double weight = 1;         ///< of the column
  std::vector<std::pair<int, double>> also = {};  ///< further columns with their weights
};

/// Low-passes a fine stream where it is asked to. All channels have one delay, delay_steps() fine
/// steps, besides what their taps add.
class Decimator {
 public:
  Decimator(std::vector<DecimatorChannel> channels, int columns);

  int delay_steps() const { return delay_steps_; }
  void push(const Eigen::VectorXd& fine);
  /// Channels as they were delay_steps() pushes before the newest.
  const Eigen::VectorXd& output();

 private:
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  std::vector<DecimatorChannel> channels_;
  int delay_steps_;
  int length_;
  RowMajor ring_;  ///< columns x (history twice), so that a history is always in one piece
  int newest_ = 0;
  Eigen::VectorXd output_;
};

}  // namespace framewatch::estimator
