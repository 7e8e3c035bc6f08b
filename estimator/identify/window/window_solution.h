// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "estimator/identify/estimate/estimate.h"
#include "estimator/identify/gram/sliding_gram.h"
#include "estimator/identify/regressors/row_tuning.h"
#include "estimator/identify/solve/influential_part.h"
#include "estimator/identify/solve/noise_compensation.h"
#include "estimator/identify/solve/story_solver.h"
#include "estimator/identify/solve/uncertainty.h"
#include "estimator/setup/pipeline_config.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// The solution of one window. It solves the normal equations, minus the expected sensor noise,
/// computes standard errors, and decides for every parameter if it is published. docs/equations.md
/// (18), (21), (22).
class WindowSolution {
 public:
  /// compensation: share of the noise, see NoiseCompensation. warm: share of the window in which a
  /// floor must have had rows.
  WindowSolution(const Structure& structure, const FloorLayout& layout, const ParameterTable& table,
                 const EstimatorOptions& options, double compensation = kCompensatedShare,
                 double warm = 0.5);

  /// Holds the unknown at `ratio` of theta0, which is known within a relative standard error. That
  /// error counts in the errors of the other unknowns.
  void hold(int unknown, double ratio, double std_error);
  /// Resets errors and noise level to unknown after an interruption.
  void restart();
  /// The corrections that the rows of a tuning permit. regularise: noise may be subtracted and the
  /// prior added. noise_known: the noise of every axis is configured or measured.
  struct Trust {
    bool regularise, noise_known;
  };
  /// Solves a window. The noise level is that of the last solution that closed a block, so a
  /// window's values do not depend on how often windows are requested.
  void solve(const WindowParts& sums, const RowFilter& rows, const Trust& trust, bool closes_block);

  /// Begins a pass of standard errors, spread over instants (BatchMeans, InfluentialPart). blocks:
  /// length of the window in blocks of `all`. main: the solution of BatchMeans::kBlocks blocks,
  /// which gives the errors of a shorter window. Does nothing until both have solved these rows:
  /// the block that fills a window for the first time closes earlier, and errors would be zero.
  template <typename Sums>
  void begin_errors(const Sums& all, int blocks, const WindowSolution& main) {
    if (fresh_ || main.fresh_) return;
    const StorySolver& fit = (blocks < BatchMeans::kBlocks ? main : *this).solver_;
    const BatchMeans::Fit of{std::max(blocks, BatchMeans::kBlocks), &fit.solution(),
                             &fit.information()};
    influential_.begin(all, blocks, solver_, prior_, centre_, noise_);
    errors_.begin(all, solver_, of, prior_, doubt_, noise_, noise_scale_);
  }
  bool advance_errors(int steps);
  /// Abandons a pass in progress, because the next solution comes from other rows. Errors remain.
  void retuned() {
    errors_.cancel();
    influential_.cancel();
    fresh_ = true;
  }
  int error_steps() const { return errors_.steps(); }
  const std::vector<double>& std_error() const { return std_error_; }
  /// Multiplies the results of an unknown by `factor`, because its theta0 has changed.
  void rescale(int unknown, double factor);
  /// Returns ModelMisfit::misfit() of the last closed block; NaN if the window does not show the
  /// unknown.
  double misfit(int unknown) const;
  /// Returns ModelMisfit::error() of the last pass, relative to the solution.
  double misfit_error(int unknown) const;
  /// Returns the unknown whose solution this one takes, usually itself.
  int stands_for(int unknown) const {
    return same_as_.empty() ? unknown : same_as_[static_cast<std::size_t>(unknown)];
  }

  const StorySolver& solver() const { return solver_; }
  StorySolver& solver() { return solver_; }
  /// Returns true if the window's motion shows the unknown above the sensors' noise.
  bool shown(int unknown) const;
  /// Returns true if the floor's rows fill enough of the window.
  bool warm(int floor) const { return warm_[static_cast<std::size_t>(floor)] == kWarm; }

  /// The conditions, besides the numbers, that decide if a parameter is published.
  struct Situation {
    const Eigen::VectorXd* theta0;           ///< the parameters that x is relative to, theta order
    const std::vector<std::uint8_t>* known;  ///< places with a working sensor, as in DeformationSet
    bool tuned;                              ///< the filters have been found to match
    /// The main window, if this is another one. It is short and always solved, so it knows what the
    /// model usually leaves, and the errors of shorter windows come from its blocks.
    const WindowSolution* main = nullptr;
  };
  /// Fills in everything that follows from this window. Times, boxplots and last values are left to
  /// the caller.
  void fill(const Situation& situation, WindowEstimate& estimate);

  /// rows, sums: of the active regression.
  void archive(auto& a, const RowFilter& rows, const auto& sums) {
    noise_.archive(a, rows);
    errors_.archive(a, rows, sums);
    a.each_within(same_as_, 0, layout_.unknowns() - 1.0);
    a.finite(share_error_);
    a(misfit_);
    a.finite(misfit_error_);
    for (Unknown& unknown : unknowns_) a.within(unknown.prior, 0, a.kMax);
    for (double& centre : centre_) a.within(centre, 0, a.kMax);
    a.finite(doubt_);
    a(solver_, prior_, warm_, known_, place_known_, errors_known_, solved_, noise_known_, fresh_,
      overcompensated_);
    a.finite(residual_energy_, noise_scale_, noise_level_);
    if (a.since(18)) {
      influential_.archive(a, rows, sums);
      a(std_error_, checked_);
    } else {
      influential_.restart(solver_.solution());
      std_error_ = errors_.std_error();
      checked_ = solver_.solution();
    }
  }

 private:
  struct Unknown {
    int parameter;
    ParameterKind kind;
    double prior;        ///< weight of the prior over the noise level
    double error_limit;  ///< relative standard error above which the parameter is not published
    bool held = false;   ///< hold() applies whatever the Trust
  };
  bool place_known(int unknown) const;
  bool equation_lost(int unknown) const;
  bool rowless(int floor) const;
  void see(const std::vector<std::uint8_t>& known);
  bool published(int unknown, const ModelMisfit& usual) const;
  double present_error(int unknown, const ModelMisfit& usual) const;
  /// Returns the noise level that motion must exceed, over the level that the tuning assumes.
  double gate_level() const;
  bool looks_symmetric(const WindowEstimate& estimate) const;

  Structure structure_;
  FloorLayout layout_;
  ParameterTable table_;
  EstimatorOptions options_;
  std::vector<Unknown> unknowns_;  ///< internal order
  NoiseCompensation noise_;
  double warm_share_;
  StorySolver solver_;
  BatchMeans errors_;
  InfluentialPart influential_;
  std::vector<double> std_error_;     ///< of the last pass, internal order, relative to theta0
  std::vector<double> checked_;       ///< the solution that std_error_ belongs to
  ModelMisfit misfit_;                ///< misfit of the last closed block
  std::vector<double> misfit_error_;  ///< internal order, relative to theta0
  std::vector<double> prior_;
  std::vector<double> centre_, doubt_;  ///< center and doubt of the prior, for hold()
  std::vector<int> same_as_;            ///< FloorRows::same_as of a building in groups
  std::vector<double> share_error_;     ///< FloorRows::share_error of a building in groups
  /// By floor: kWarm if its rows fill most of the window, kRowless if it has no rows there.
  static constexpr std::uint8_t kFilling = 0, kWarm = 1, kRowless = 2;
  std::vector<std::uint8_t> warm_;
  std::vector<std::uint8_t> known_;        ///< last Situation::known
  std::vector<std::uint8_t> place_known_;  ///< by unknown: all motion that it needs is known
  bool errors_known_ = false;
  bool solved_ = false;
  bool noise_known_ = false;  ///< Trust::noise_known of the last solution
  bool fresh_ = true;         ///< the noise level belongs to other rows or is unknown
  /// More noise was subtracted than the window holds, so its values are invalid.
  bool overcompensated_ = false;
  double residual_energy_ = 0;
  double noise_scale_ = 0;  ///< residual energy over the part that sensor noise explains
  double noise_level_ = 0;  ///< noise_scale_ of the last closed block
};

}  // namespace framewatch::estimator
