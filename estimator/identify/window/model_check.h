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

/// The regression once more, with other corners of its oscillator sections, over windows that
/// now and then: where the model is right they give the same numbers. Allocates when
/// constructed, never after.
class OtherCorner {
 public:
  /// tuning: with the other corners. rows: instants of a window.
  OtherCorner(std::unique_ptr<RowTuning> tuning, const Structure& structure,
              const FloorLayout& layout, const ParameterTable& table,
              const EstimatorOptions& options, int rows);

  /// Begins anew, `settle` instants before the first window.
  void restart(int settle);
  /// Other axes or parameters of the rows; restart() follows once tune() has come to its end.
  void retune(const RowTuning& active);
  /// One instant's share of tuning; false: nothing is left to be tuned.
  bool tune();
  int settle_rows(int least) const { return tuning_->settle_rows(least); }

  /// The newest instant of the ring; nothing once full.
  void advance(const MotionRing& ring);
  bool full() const { return count_ >= rows_; }
  /// Of a full window, which the next one follows.
  const WindowSolution& solve(const WindowSolution::Trust& trust);
  /// The sums of the window that was solved last, until restart().
  const std::vector<double>& sums() const { return sum_; }
  const GramShape& shape() const { return shape_; }
  WindowSolution& solution() { return solution_; }

  /// It was tuned anew and has no rows until restart().
  bool resting() const { return resting_; }

  template <typename Archive>
  void archive(Archive& a) {
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
  // Blocks of batch means, of which there are none.
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
  bool resting_ = true;  ///< until restart(): the filter is of what it was tuned to before
};

/// How far the model itself may be wrong: what the equations of the main window leave beyond noise;
/// over windows that follow each other, what other corners of the row filters make of the values;
/// what masses and stories that are off by their tolerance do. A fixed share of the work per
/// instant. docs/equations.md, errors of the model.
class ModelCheck {
 public:
  using MakeTuning = std::function<std::unique_ptr<RowTuning>(const EstimatorOptions& options)>;
  /// config must outlive this. make_tuning: of rows by these options, which outlive them.
  ModelCheck(const PipelineConfig& config, const ParameterTable& table, const FloorLayout& layout,
             int window_rows, const MakeTuning& make_tuning);

  /// The input was interrupted.
  void restart();
  /// The active regression is another one.
  void regression_exchanged(const RowTuning& active);

  /// WindowSolution::hold() of both corners.
  void hold(int unknown, double ratio, double std_error);

  struct Context {
    const WindowSolution* main;
    const MotionRing* ring;
    WindowSolution::Trust trust;
    bool tuned;
    bool whole;       ///< the main window is as long as it gets
    bool errors_new;  ///< its standard errors are those of a new block
    Time end;         ///< of the window that ends now
  };
  /// One instant's share; once a second the fit, otherwise null.
  const ModelFit* advance(const Context& context);

  template <typename Archive>
  void archive(Archive& a) {
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
  static constexpr int kMisfits = 24, kSpreads = 6;  ///< fits, windows that are averaged over
  static constexpr int kPause =
      2;  ///< windows that are left out between two: what is looked for stays
  enum class Phase { tuning, filling, low, high, masses, pausing };
  void pause();
  void advance_corners(const Context& context);
  void take_spread(const Context& context);
  void take_misfit(const Context& context);
  const ModelFit& give(const Context& context);
  /// Parameter of an unknown in internal order.
  std::size_t parameter(int unknown) const {
    return static_cast<std::size_t>(
        layout_.parameter(unknown / layout_.own(), unknown % layout_.own()));
  }

  const PipelineConfig* config_;
  ParameterTable table_;
  FloorLayout layout_;
  /// Held here, because tunings keep a reference.
  std::array<EstimatorOptions, 2> options_;
  std::vector<OtherCorner> corners_;  ///< lower, higher
  MassErrors masses_;
  int window_rows_, settle_rows_, masses_per_instant_;
  Phase phase_ = Phase::tuning;
  ModelFit fit_;
  std::vector<double> low_;         ///< solution with the lower corners, internal order
  std::vector<double> mass_error_;  ///< by parameter, relative
  // By parameter, running means of squares and how many are in them.
  std::vector<double> misfit_square_, corner_square_;
  std::vector<int> misfits_, spreads_;
  int blocks_ = 0;  ///< since the last fit
  int pause_left_ = 0;
};

}  // namespace framewatch::estimator
