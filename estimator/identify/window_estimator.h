#pragma once

#include <memory>
#include <vector>

#include "estimator/identify/boxplot.h"
#include "estimator/identify/estimate.h"
#include "estimator/identify/machine.h"
#include "estimator/identify/self_tuning.h"
#include "estimator/pipeline.h"

namespace framewatch {

/// Calibrated sample sets in, window estimates out: the method, step by step.
class WindowEstimator {
 public:
  WindowEstimator(const PipelineConfig& config, const ParameterTable& table);

  /// One instant. Returns the estimate of the window that ends there, or null between hops.
  const WindowEstimate* push(const SampleSet& set);

  const Eigen::VectorXd& design() const { return active_->tuning().design(); }
  int window_rows() const { return blocks_ * block_rows_; }
  int hop_rows() const { return hop_rows_; }
  std::int64_t gaps() const { return gaps_; }
  std::int64_t retunes() const { return self_tuning_ ? self_tuning_->retunes() : 0; }

 private:
  void restart();
  void look_at_tuning();
  /// The filters are right, as far as is known.
  bool tuned() const { return self_tuning_ == nullptr || self_tuning_->tuned(); }
  std::unique_ptr<Machine> make_machine(const Eigen::VectorXd& design) const;
  void solve();
  void fill_estimate(Time time);
  Observability judge(int unknown, bool known, bool warm) const;
  bool element_known(int unknown, const std::vector<std::uint8_t>& known) const;

  struct Unknown {
    int parameter;
    bool frame_stiffness;
    double error_limit;  ///< relative standard error above which it is not published
  };

  Structure structure_;
  std::vector<SensorAxis> axes_;
  EstimatorOptions options_;
  ParameterTable table_;
  FloorLayout layout_;
  Deformations deformations_;
  DerivativeTriple triple_;
  HighPass high_pass_;
  int blocks_, block_rows_, hop_rows_, settle_rows_;
  MotionFilter filter_;
  MotionRing ring_;
  std::unique_ptr<Machine> active_;
  std::unique_ptr<SelfTuning> self_tuning_;  ///< null when switched off
  NoiseShare noise_;
  StorySolver solver_;
  std::vector<double> tolerance_;  ///< of the design, internal order
  BatchMeans batch_means_;
  int steps_per_instant_ = 1;  ///< of a pass of batch_means_: done before the next block closes
  bool errors_known_ = false;  ///< batch means exist for the present run of windows
  std::vector<std::uint8_t> shown_;  ///< of look_at_tuning()
  double residual_energy_ = 0;
  double noise_scale_ = 0;         ///< residual energy over what sensor noise explains
  std::vector<Unknown> unknowns_;  ///< internal order
  std::vector<double> prior_;
  bool noise_configured_;  ///< of every axis
  std::vector<BoxplotWindow> boxplots_;
  WindowEstimate estimate_;
  std::int64_t expected_index_ = -1, since_hop_ = 0, gaps_ = 0;
};

}  // namespace framewatch
