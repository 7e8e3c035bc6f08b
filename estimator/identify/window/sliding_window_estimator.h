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

/// The method, step by step, one instant after the other: drift-controlled integration, element
/// deformations, rows of the regression, the sliding sum of H^T H, its solution with standard
/// errors, boxplots. Calibrated sample sets in; out, every hop (0.01 s), the estimate of the window
/// (5 s) that ends there.
class SlidingWindowEstimator {
 public:
  SlidingWindowEstimator(const PipelineConfig& config, const ParameterTable& table);

  /// The filters are tuned to this from the first instant on, which is still to come. Of no effect
  /// when self-tuning is switched off.
  void start_tuned(const Tuning& tuning);
  /// What the filters are tuned to; empty while the noise of an axis is not known.
  std::optional<Tuning> tuning() const;

  /// One instant. Returns the estimate of the window that ends there, or null between hops.
  const WindowEstimate* push(const SampleSet& set);
  /// Before push(): instants between the last one and `set` that are missing, and that
  /// push_missing() is to be called for. 0 when there is none, and when so many are missing, or the
  /// clock has gone back, that push() begins anew.
  int missing_before(const SampleSet& set) const;
  /// An instant without any sample: rows from before it stay in the windows. No window ends there.
  void push_missing();
  /// The estimate of another window that the last push completed, or null.
  const WindowEstimate* other() const { return other_; }
  /// A window that was held back while the filters were not tuned (LateWindows), after a push: to
  /// be called until it is null. Ends in the past; the main window or another one.
  const WindowEstimate* late();
  /// The look at the model that the last push completed, or null.
  const ModelFit* model_fit() const { return model_fit_; }

  /// The parameters that the filters are tuned to now, theta order, SI.
  const Eigen::VectorXd& theta0() const { return active_->tuning().theta0(); }
  /// The noise densities the rows are weighted by, per axis, m/s^2/sqrt(Hz); known: configured or
  /// measured, of every axis.
  const std::vector<double>& noise_density() const { return active_->tuning().noise_density(); }
  bool noise_known() const {
    return self_tuning_ ? self_tuning_->noise_known() : noise_.configured();
  }
  int window_rows() const { return blocks_ * block_rows_; }
  std::vector<int> other_window_rows() const;
  int hop_rows() const { return hop_rows_; }
  std::int64_t interruptions() const { return interruptions_; }
  std::int64_t retunes() const { return self_tuning_ ? self_tuning_->retunes() : 0; }

  template <typename Archive>
  void archive(Archive& a) {
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
  /// A state of its own: the rest can be read when the long window has another length or is absent.
  template <typename Archive>
  void archive_long(Archive& a) {
    int rows = long_ ? long_->rows() : 0;
    std::vector<std::uint8_t> bytes;
    if constexpr (Archive::kReading) {
      a(rows);
      a.any_size(bytes);
      if (!long_) return;
      StateReader state(bytes);
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
  /// Steps of the common grid from the last instant to `time`, whole.
  double steps_to(Time time) const;
  void advance(const std::vector<double>& accel, Time time);
  /// Something has got into the filters that no motion makes of them: everything begins anew.
  void recover();
  void block_closed(Time window_end);
  void go_on();
  /// The filters have just been found right: windows that have been held back are looked at again.
  void look_back();
  void check_tuning();
  void advance_long();
  void hold_bending();
  /// Of groups: a channel that is gone makes its floor an inner one, one that is back a measured
  /// one.
  void follow_axes(const std::vector<std::uint8_t>& known);
  RowTuning::Known identified() const;
  void regression_exchanged();
  /// The filters are right, as far as is known.
  bool tuned() const { return self_tuning_ == nullptr || self_tuning_->tuned(); }
  std::unique_ptr<RowTuning> make_tuning(const EstimatorOptions& options) const;
  std::unique_ptr<TunedRegression> make_regression(std::unique_ptr<RowTuning> tuning) const;
  WindowSolution::Trust trust() const { return {matched_ && tuned(), noise_known()}; }
  void fill_estimate(Time end);

  PipelineConfig config_;
  EstimatorOptions options_;
  bool matched_;  ///< the variant
  ParameterTable table_;
  FloorLayout layout_;
  std::unique_ptr<MotionSource> motion_source_;
  DerivativeTriple triple_;
  HighPass high_pass_;
  int blocks_, block_rows_, hop_rows_;
  std::vector<int> other_blocks_;
  DriftControlledIntegrator integrator_;
  AxisNoise noise_;
  MotionRing ring_;
  ElementDrift drift_;
  std::unique_ptr<TunedRegression> active_;
  std::unique_ptr<SelfTuning> self_tuning_;  ///< null when switched off
  WindowSeries series_;
  std::unique_ptr<LateWindows> late_;     ///< null without self-tuning
  std::unique_ptr<LongWindow> long_;      ///< null: none
  std::unique_ptr<HeldBending> bending_;  ///< null where frames do not bend
  std::unique_ptr<ModelCheck> check_;     ///< null of the paper's variant
  std::vector<std::uint8_t> shown_;       ///< of check_tuning()
  std::vector<double> retuned_by_;        ///< of regression_exchanged()
  std::vector<BoxplotWindow> boxplots_;
  WindowEstimate estimate_;
  const WindowEstimate* other_ = nullptr;
  const WindowEstimate* late_other_ = nullptr;  ///< to be given by the next late()
  std::int64_t late_until_ = 0;                 ///< instant of the ring
  int late_budget_ = 0;                         ///< instants that late() may still go through
  const ModelFit* model_fit_ = nullptr;
  bool errors_new_ = false;  ///< of the last push
  std::int64_t expected_index_ = -1, since_hop_ = 0, interruptions_ = 0;
  Time last_time_{};                           ///< of the last instant
  std::vector<double> nothing_;                ///< no sample of any axis
  bool due_ = false;                           ///< the last advance() was a hop
  std::vector<std::uint8_t> seen_axes_;        ///< of the last instants, of groups
  std::vector<std::uint8_t> identified_from_;  ///< of follow_axes()
  int axes_steady_rows_ = 0;                   ///< instants for which they have been these
  bool sane_ = true;  ///< the newest block of sums; not kept: looked at again
};

}  // namespace framewatch::estimator
