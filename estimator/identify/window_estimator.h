#pragma once

#include <memory>
#include <vector>

#include "estimator/identify/boxplot.h"
#include "estimator/identify/channel_noise.h"
#include "estimator/identify/estimate.h"
#include "estimator/identify/long_window.h"
#include "estimator/identify/machine.h"
#include "estimator/identify/other_windows.h"
#include "estimator/identify/self_tuning.h"
#include "estimator/identify/window_solution.h"
#include "estimator/pipeline.h"

namespace framewatch {

/// Calibrated sample sets in, window estimates out: the method, step by step.
class WindowEstimator {
 public:
  WindowEstimator(const PipelineConfig& config, const ParameterTable& table);

  /// One instant. Returns the estimate of the window that ends there, or null between hops.
  const WindowEstimate* push(const SampleSet& set);
  /// The estimate of another window that the last push completed, or null.
  const WindowEstimate* other() const { return other_; }

  const Eigen::VectorXd& design() const { return active_->tuning().design(); }
  /// The noise densities the rows are weighted by, per axis, m/s^2/sqrt(Hz); known: configured or
  /// measured, of every axis.
  const std::vector<double>& noise_density() const { return active_->tuning().noise_density(); }
  bool noise_known() const {
    return self_tuning_ ? self_tuning_->noise_known() : noise_.configured();
  }
  int window_rows() const { return blocks_ * block_rows_; }
  std::vector<int> other_window_rows() const;
  int hop_rows() const { return hop_rows_; }
  std::int64_t gaps() const { return gaps_; }
  std::int64_t retunes() const { return self_tuning_ ? self_tuning_->retunes() : 0; }

  template <typename Archive>
  void archive(Archive& a) {
    a(filter_, noise_, ring_, *active_);
    if (self_tuning_) a(*self_tuning_);
    main_.archive(a, active_->rows(), active_->sums());
    others_.archive(a, *active_);
    archive_long(a);
    a(boxplots_, estimate_, expected_index_, since_hop_, gaps_);
  }

 private:
  /// A state of its own, so that one with another long window, or none, does not spoil the rest.
  template <typename Archive>
  void archive_long(Archive& a) {
    int rows = long_ ? long_->rows() : 0;
    std::vector<std::uint8_t> bytes;
    if constexpr (Archive::kReading) {
      a(rows, bytes);
      if (!long_) return;
      StateReader state(bytes);
      if (rows == long_->rows()) long_->archive(state, *active_);
      if (rows != long_->rows() || !state.whole()) long_->retuned();
    } else {
      StateWriter state;
      if (long_) long_->archive(state, *active_);
      bytes = state.bytes();
      a(rows, bytes);
    }
  }
  void restart();
  void advance_errors(Time window_end);
  void look_at_tuning();
  void advance_long();
  void exchanged_machines();
  /// The filters are right, as far as is known.
  bool tuned() const { return self_tuning_ == nullptr || self_tuning_->tuned(); }
  std::unique_ptr<Machine> make_machine(const Eigen::VectorXd& design) const;
  WindowSolution::Trust trust() const { return {matched_ && tuned(), noise_known()}; }
  void fill_estimate(Time end);

  Structure structure_;
  std::vector<SensorAxis> axes_;
  EstimatorOptions options_;
  bool matched_;  ///< the variant
  ParameterTable table_;
  FloorLayout layout_;
  Deformations deformations_;
  DerivativeTriple triple_;
  HighPass high_pass_;
  int blocks_, block_rows_, hop_rows_, settle_rows_;
  std::vector<int> other_blocks_;
  MotionFilter filter_;
  ChannelNoise noise_;
  MotionRing ring_;
  std::unique_ptr<Machine> active_;
  std::unique_ptr<SelfTuning> self_tuning_;  ///< null when switched off
  WindowSolution main_;
  OtherWindows others_;
  std::unique_ptr<LongWindow> long_;  ///< null: none
  int steps_per_instant_ = 1;         ///< of a pass of errors: done before the next block closes
  std::vector<std::uint8_t> shown_;   ///< of look_at_tuning()
  std::vector<BoxplotWindow> boxplots_;
  WindowEstimate estimate_;
  const WindowEstimate* other_ = nullptr;
  std::int64_t expected_index_ = -1, since_hop_ = 0, gaps_ = 0;
};

}  // namespace framewatch
