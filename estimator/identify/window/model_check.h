// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "estimator/identify/estimate/estimate.h"
#include "estimator/identify/gram/sliding_gram.h"
#include "estimator/identify/regressors/row_tuning.h"
#include "estimator/identify/solve/uncertainty.h"
#include "estimator/identify/window/tuned_regression.h"
#include "estimator/identify/window/window_solution.h"
#include "estimator/setup/pipeline_config.h"

namespace framewatch::estimator {

/// A second regression with other corner frequencies of its oscillator sections. It solves a window
/// now and then; if the model is right, its values equal those of the main regression. Allocates
/// only in the constructor.
class OtherCorner {
 public:
  /// tuning: with the other corners. rows: instants in a window.
  OtherCorner(std::unique_ptr<RowTuning> tuning, const Structure& structure,
              const FloorLayout& layout, const ParameterTable& table,
              const EstimatorOptions& options, int rows);

  /// Starts anew, `settle` instants before the first window.
  void restart(int settle);
  /// Begins to tune to other axes or parameters of `active`. Call tune() until it returns false,
  /// then restart().
  void retune(const RowTuning& active);
  /// Does one instant's share of tuning. Returns false if nothing is left to tune.
  bool tune();
  int settle_rows(int least) const { return tuning_->settle_rows(least); }

  /// Takes the newest instant of the ring. Does nothing once the window is full.
  void advance(const MotionRing& ring);
  bool full() const { return count_ >= rows_; }
  /// Solves the full window. The next window follows.
  const WindowSolution& solve(const WindowSolution::Trust& trust);
  /// Returns the sums of the window solved last, until restart().
  const std::vector<double>& sums() const { return sum_; }
  const GramShape& shape() const { return shape_; }
  WindowSolution& solution() { return solution_; }

  /// Returns true after retuning, until restart(): there are no rows then.
  bool resting() const { return resting_; }

  void archive(auto& a) {
    a(*tuning_);
    a.within(next_part_, 0, a.kMaxCount);
    a(resting_);
    if (!resting_) a(*rows_filter_);
    a.finite(sum_);
    a.each_within(instants_, 0, a.kMaxCount);
    a.within(count_, 0, rows_);
    a.within(settling_, 0, a.kMaxCount);
    solution_.archive(a, *rows_filter_, *this);
  }
  // Stand for the blocks of batch means, which this regression does not have.
  std::int64_t number_of(const double*) const { return -1; }
  const double* block_of(std::int64_t) const { return nullptr; }

 private:
  std::unique_ptr<RowTuning> tuning_;
  std::unique_ptr<RowFilter> rows_filter_;
  GramShape shape_;
  int floors_, rows_, parts_per_instant_;
  WindowSolution solution_;
  std::vector<double> sum_, zero_;
  std::vector<int> instants_;  ///< by floor
  int count_ = 0, settling_ = 0;
  int next_part_ = 0;
  bool resting_ = true;  ///< until restart(), the filter belongs to the former tuning
};

/// Measures how far the model itself may be wrong, from three effects. The first is what the
/// equations of the main window leave beyond noise. The second is how much other corner frequencies
/// of the row filters change the values, over consecutive windows. The third is what masses and
/// stories that are off by their tolerance do. Each instant does a fixed share of the work.
/// docs/equations.md, errors of the model.
class ModelCheck {
 public:
  using MakeTuning = std::function<std::unique_ptr<RowTuning>(const EstimatorOptions& options)>;
  /// config must outlive the object. make_tuning: returns a tuning of rows with the given options,
  /// which outlive it.
  ModelCheck(const PipelineConfig& config, const ParameterTable& table, const FloorLayout& layout,
             int window_rows, const MakeTuning& make_tuning);

  /// Starts anew after an interruption of the input.
  void restart();
  /// Retunes to a new active regression.
  void regression_exchanged(const RowTuning& active);

  /// Applies WindowSolution::hold() at both corners.
  void hold(int unknown, double ratio, double std_error);

  struct Context {
    const WindowSolution* main;
    const MotionRing* ring;
    WindowSolution::Trust trust;
    bool tuned;
    bool whole;       ///< the main window has its full length
    bool errors_new;  ///< the window's standard errors come from a new block
    Time end;         ///< end of the present window
  };
  /// Does one instant's share of the work. Returns the fit once a second, otherwise nullptr.
  const ModelFit* advance(const Context& context);

  void archive(auto& a) {
    for (OtherCorner& corner : corners_) a(corner);
    a.within(phase_, 0, static_cast<double>(Phase::pausing));
    for (const OtherCorner& corner : corners_)
      if (phase_ != Phase::tuning && corner.resting()) a.refuse();
    masses_.archive(a, corners_[1].shape(), corners_[1].sums());
    a(fit_);
    a.finite(low_, mass_error_, misfit_square_, corner_square_);
    a.each_within(misfits_, 0, kMisfits);
    a.each_within(spreads_, 0, kSpreads);
    a.within(blocks_, 0, kEvery);
    a.within(pause_left_, 0, a.kMaxCount);
  }

 private:
  static constexpr int kEvery = 4;                   ///< blocks between fits
  static constexpr int kMisfits = 24, kSpreads = 6;  ///< fits and windows in the averages
  static constexpr int kPause = 2;                   ///< windows skipped between two
  enum class Phase { tuning, filling, low, high, masses, pausing };
  void pause();
  void advance_corners(const Context& context);
  void take_spread(const Context& context);
  void take_misfit(const Context& context);
  const ModelFit& give(const Context& context);
  /// Returns the parameter of an unknown in internal order.
  std::size_t parameter(int unknown) const {
    return static_cast<std::size_t>(layout_.parameter_of(unknown));
  }

  const PipelineConfig* config_;
  ParameterTable table_;
  FloorLayout layout_;
  /// Kept here because the tunings refer to them.
  std::array<EstimatorOptions, 2> options_;
  std::vector<OtherCorner> corners_;  ///< lower, higher
  MassErrors masses_;
  int window_rows_, settle_rows_, masses_per_instant_;
  Phase phase_ = Phase::tuning;
  ModelFit fit_;
  std::vector<double> low_;         ///< solution with the lower corners, internal order
  std::vector<double> mass_error_;  ///< by parameter, relative
  // Running means of squares by parameter, and the number of values in them.
  std::vector<double> misfit_square_, corner_square_;
  std::vector<int> misfits_, spreads_;
  int blocks_ = 0;  ///< blocks since the last fit
  int pause_left_ = 0;
};

}  // namespace framewatch::estimator
