// SPDX-License-Identifier: MIT
#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>

namespace framewatch::estimator {

/// Returns a linear-phase low-pass (Kaiser-windowed sinc) with unit gain at 0 Hz. It passes up to
/// 0.4 of the output rate within 1e-4 and stops from 0.6 on by 80 dB. ratio: fine steps per output
/// step. delay: of the result, fine steps, not necessarily whole. The number of taps is odd, and
/// they are centered.
std::vector<double> anti_alias_taps(int ratio, double delay = 0);

/// One output of a Decimator.
struct DecimatorChannel {
  int column;                ///< of the fine stream
  std::vector<double> taps;  ///< an odd number, centered; {1} passes the stream through
  double weight = 1;         ///< of the column
  std::vector<std::pair<int, double>> also = {};  ///< further columns with their weights
};

/// Filters a fine stream at the instants of its outputs. All channels share a delay of
/// delay_steps() fine steps, in addition to that of their taps.
class Decimator {
 public:
  Decimator(std::vector<DecimatorChannel> channels, int columns);

  int delay_steps() const { return delay_steps_; }
  void push(const Eigen::VectorXd& fine);
  /// Returns the channels as they were delay_steps() pushes before the newest.
  const Eigen::VectorXd& output();

 private:
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  std::vector<DecimatorChannel> channels_;
  int delay_steps_;
  int length_;
  RowMajor ring_;  ///< columns x (history twice), so that a history is contiguous
  int newest_ = 0;
  Eigen::VectorXd output_;
};

}  // namespace framewatch::estimator
