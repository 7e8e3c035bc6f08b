// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "estimator/identify/elements/deformations.h"
#include "estimator/identify/estimate/boxplot.h"
#include "estimator/identify/estimate/estimate.h"
#include "estimator/identify/noise/axis_noise.h"
#include "estimator/identify/window/element_drift.h"
#include "estimator/identify/window/long_window.h"
#include "estimator/identify/window/model_check.h"
#include "estimator/identify/window/self_tuning.h"
#include "estimator/identify/window/tuned_regression.h"
#include "estimator/identify/window/window_series.h"
#include "estimator/setup/pipeline_config.h"
#include "estimator/state/archive.h"

namespace framewatch::estimator {

/// The estimation, instant by instant: drift-controlled integration, element deformations, rows of
/// the regression, sliding sum of H^T H, solution with standard errors, boxplots. Takes calibrated
/// sample sets. Returns at every hop (0.01 s) the estimate of the window (5 s) that ends there.
class SlidingWindowEstimator {
 public:
  SlidingWindowEstimator(const PipelineConfig& config, const ParameterTable& table);

  /// Tunes the filters from the first instant on; call it before push(). Has no effect if
  /// self-tuning is off.
  void start_tuned(const Tuning& tuning);
  /// Returns the present tuning of the filters; empty while the noise of an axis is unknown.
  std::optional<Tuning> tuning() const;

  /// Takes one instant. Returns the estimate of the window that ends there, or nullptr between
  /// hops.
  const WindowEstimate* push(const SampleSet& set);
  /// Returns how many instants are missing between the last one and `set`: call push_missing() once
  /// for each, then push(). Returns 0 if none is missing, and also if push() must start anew,
  /// because too many are missing or the clock has gone back.
  int missing_before(const SampleSet& set) const;
  /// Begins all windows anew, because samples that they hold were wrong.
  void forget_motion();
  /// Takes an instant without any sample. Earlier rows stay in the windows. No window ends there.
  void push_missing();
  /// Returns the estimate of another window that the last push completed, or nullptr.
  const WindowEstimate* other() const { return other_; }
  /// Returns a window that was held back while the filters were not tuned (LateWindows), or
  /// nullptr. Call it after a push until it returns nullptr. The window ended in the past; it is
  /// the main window or another one.
  const WindowEstimate* late();
  /// Returns the model fit that the last push completed, or nullptr.
  const ModelFit* model_fit() const { return model_fit_; }

  /// Returns the parameters that the filters are tuned to, theta order, SI.
  const Eigen::VectorXd& theta0() const { return active_->tuning().theta0(); }
  /// Return the noise densities that weight the rows, per axis, m/s^2/sqrt(Hz), and true if every
  /// axis is configured or measured.
  const std::vector<double>& noise_density() const { return active_->tuning().noise_density(); }
  bool noise_known() const {
    return self_tuning_ ? self_tuning_->noise_known() : noise_.configured();
  }
  int window_rows() const { return blocks_ * block_rows_; }
  std::vector<int> other_window_rows() const;
  int hop_rows() const { return hop_rows_; }
  std::int64_t interruptions() const { return interruptions_; }
  std::int64_t retunes() const { return self_tuning_ ? self_tuning_->retunes() : 0; }

  void archive(auto& a) {
    a(integrator_, noise_, ring_, drift_, *active_);
    if (self_tuning_) a(*self_tuning_);
    series_.archive(a, *active_);
    a.within(late_until_, 0, a.kMaxCount);
    if (late_) late_->archive(a, self_tuning_->standby());
    archive_long(a);
    if (bending_) bending_->archive(a, *active_);
    if (check_) a(*check_);
    a(boxplots_, estimate_);
    a.each_within(seen_axes_, 0, 1);
    a.within(axes_steady_rows_, 0, a.kMaxCount);
    a.within(expected_index_, -1, a.kMaxCount);
    a(last_time_);
    a.within(since_hop_, 0, hop_rows_);
    a.within(interruptions_, 0, a.kMaxCount);
    if (active_->next() != ring_.end() || active_->resting()) a.refuse();
  }

 private:
  /// Archives the long window separately, so that the rest can be read if the long window has
  /// another length or is absent.
  void archive_long(auto& a) {
    int rows = long_ ? long_->rows() : 0;
    std::vector<std::uint8_t> bytes;
    if (a.kReading) {
      a(rows);
      a.any_size(bytes);
      if (!long_) return;
      StateReader state(bytes, a.format());
      if (rows == long_->rows()) long_->archive(state, *active_);
      if (rows != long_->rows() || !state.whole()) long_->retuned();
    } else {
      StateWriter state;
      if (long_) long_->archive(state, *active_);
      bytes = state.bytes();
      a(rows);
      a.any_size(bytes);
    }
  }
  void restart();
  /// Returns the whole steps of the common grid from the last instant to `time`.
  double steps_to(Time time) const;
  void advance(const std::vector<double>& accel, Time time);
  /// Starts everything anew, because the filters hold values that no motion produces.
  void recover();
  void block_closed(Time window_end);
  void go_on();
  /// Starts to compute the windows that were held back, because the filters have just been found to
  /// match.
  void look_back();
  void check_tuning();
  void advance_long();
  void hold_bending();
  /// For groups: the floor of a missing channel becomes an inner floor; it becomes a measured one
  /// when the channel returns.
  void follow_axes(const std::vector<std::uint8_t>& known);
  RowTuning::Known identified() const;
  void regression_exchanged();
  MotionSource& motion_source() {
    if (deformations_) return *deformations_;
    return *axis_motion_;
  }
  /// Returns true if the filters match, as far as is known.
  bool tuned() const { return self_tuning_ == nullptr || self_tuning_->tuned(); }
  std::unique_ptr<RowTuning> make_tuning(const EstimatorOptions& options) const;
  std::unique_ptr<TunedRegression> make_regression(std::unique_ptr<RowTuning> tuning) const;
  WindowSolution::Trust trust() const { return {matched_ && tuned(), noise_known()}; }
  void fill_estimate(Time end);

  PipelineConfig config_;
  EstimatorOptions options_;
  bool matched_;  ///< the matched variant
  ParameterTable table_;
  FloorLayout layout_;
  std::unique_ptr<Deformations> deformations_;  ///< null with groups of stories
  std::unique_ptr<AxisMotion> axis_motion_;     ///< null without
  DerivativeTriple triple_;
  HighPass high_pass_;
  int blocks_, block_rows_, hop_rows_;
  std::vector<int> other_blocks_;
  DriftControlledIntegrator integrator_;
  AxisNoise noise_;
  MotionRing ring_;
  ElementDrift drift_;
  std::unique_ptr<TunedRegression> active_;
  std::unique_ptr<SelfTuning> self_tuning_;  ///< nullptr if self-tuning is off
  WindowSeries series_;
  std::unique_ptr<LateWindows> late_;     ///< nullptr without self-tuning
  std::unique_ptr<LongWindow> long_;      ///< nullptr without long windows
  std::unique_ptr<HeldBending> bending_;  ///< nullptr if frames do not bend
  std::unique_ptr<ModelCheck> check_;     ///< nullptr in the paper's variant
  std::vector<std::uint8_t> shown_;       ///< buffer of check_tuning()
  std::vector<double> retuned_by_;        ///< buffer of regression_exchanged()
  std::vector<BoxplotWindow> boxplots_;
  WindowEstimate estimate_;
  const WindowEstimate* other_ = nullptr;
  const WindowEstimate* late_other_ = nullptr;  ///< next result of late()
  std::int64_t late_until_ = 0;                 ///< instant of the ring where late() ends
  int late_budget_ = 0;                         ///< instants that late() may still process
  const ModelFit* model_fit_ = nullptr;
  bool errors_new_ = false;  ///< by the last push
  std::int64_t expected_index_ = -1, since_hop_ = 0, interruptions_ = 0;
  Time last_time_{};                           ///< time of the last instant
  std::vector<double> nothing_;                ///< one NaN per axis: an instant without samples
  bool due_ = false;                           ///< the last advance() was at a hop
  std::vector<std::uint8_t> seen_axes_;        ///< axes of the last instants, for groups
  std::vector<std::uint8_t> identified_from_;  ///< axes that follow_axes() has tuned to
  int axes_steady_rows_ = 0;                   ///< instants since seen_axes_ changed
  bool sane_ = true;  ///< the newest block of sums is plausible; checked again after a restart
};

}  // namespace framewatch::estimator
