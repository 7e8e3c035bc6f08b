#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "estimator/identify/estimate/estimate.h"
#include "estimator/identify/gram/sliding_gram.h"
#include "estimator/identify/regressors/row_tuning.h"
#include "estimator/identify/solve/noise_compensation.h"
#include "estimator/identify/solve/story_solver.h"
#include "estimator/identify/solve/uncertainty.h"
#include "estimator/setup/pipeline_config.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// The solution of one window: its normal equations, from which the expected sensor noise is
/// subtracted, solved, with standard errors, and a decision on every parameter whether it is
/// published. docs/equations.md (18), (21), (22).
class WindowSolution {
 public:
  /// compensation: share of the noise, see NoiseCompensation. warm: share of the window in which a
  /// floor must have had rows.
  WindowSolution(const Structure& structure, const FloorLayout& layout, const ParameterTable& table,
                 const EstimatorOptions& options, double compensation = kCompensatedShare,
                 double warm = 0.5);

  /// The unknown is held at `ratio` of theta0, known from elsewhere within a relative standard
  /// error that counts in those of the others.
  void hold(int unknown, double ratio, double std_error);
  /// After an interruption: errors and noise level are unknown again.
  void restart();
  /// What the rows of a tuning allow. regularise: noise may be subtracted and the prior be added;
  /// noise_known: it is configured or measured, of every axis.
  struct Trust {
    bool regularise, noise_known;
  };
  /// The level of the noise is that of the last solution that closed a block: a window's numbers do
  /// not depend on how often windows are asked for.
  void solve(const WindowParts& sums, const RowFilter& rows, const Trust& trust, bool closes_block);

  /// A pass of standard errors, spread over instants (BatchMeans). fit: the solution that fits
  /// BatchMeans::kBlocks blocks, this one or another. Begins nothing before both have solved these
  /// rows: the block that fills a window for the first time closes before that, and errors would be
  /// zero.
  template <typename Sums>
  void begin_errors(const Sums& all, const WindowSolution& fit) {
    if (fresh_ || fit.fresh_) return;
    const BatchMeans::Fit of{&fit.solver_.solution(), &fit.solver_.information()};
    errors_.begin(all, solver_, of, prior_, doubt_, noise_, noise_scale_);
  }
  bool advance_errors(int steps);
  /// The next solution is of other rows: a pass under way is abandoned, errors stay.
  void retuned() {
    errors_.cancel();
    fresh_ = true;
  }
  int error_steps() const { return errors_.steps(); }
  const std::vector<double>& std_error() const { return errors_.std_error(); }
  void rescale(int unknown, double factor) { errors_.rescale(unknown, factor); }
  /// ModelMisfit of the last closed block, NaN where the window does not show the unknown.
  double misfit(int unknown) const;
  /// ModelMisfit::error(), relative to the solution; of the last pass of errors.
  double misfit_error(int unknown) const;
  /// Whose solution an unknown has: mostly its own.
  int stands_for(int unknown) const {
    return same_as_.empty() ? unknown : same_as_[static_cast<std::size_t>(unknown)];
  }

  const StorySolver& solver() const { return solver_; }
  StorySolver& solver() { return solver_; }
  /// Whether the window's motion shows the unknown above the sensors' noise.
  bool shown(int unknown) const;
  /// Whether the floor's rows fill enough of the window.
  bool warm(int floor) const { return warm_[static_cast<std::size_t>(floor)] == kWarm; }

  /// What the decision on a parameter depends on besides the numbers.
  struct Situation {
    const Eigen::VectorXd* theta0;           ///< what x is relative to, theta order
    const std::vector<std::uint8_t>* known;  ///< places with a working sensor, DeformationSet
    bool tuned;                              ///< the filters have been found right
    /// That of the window whose blocks standard errors come from, when it is another one.
    const WindowSolution* errors_of = nullptr;
  };
  /// Fills in what follows from this window; not times, boxplots and last values.
  void fill(const Situation& situation, WindowEstimate& estimate);

  /// rows, sums: of the active regression.
  template <typename Archive, typename Sums>
  void archive(Archive& a, const RowFilter& rows, const Sums& sums) {
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
  }

 private:
  struct Unknown {
    int parameter;
    ParameterKind kind;
    double prior;        ///< its weight over the level of the noise
    double error_limit;  ///< relative standard error above which it is not published
    bool held = false;   ///< hold(): whatever the Trust
  };
  bool place_known(int unknown) const;
  bool rowless(int floor) const;
  void see(const std::vector<std::uint8_t>& known);
  bool published(int unknown) const;
  /// Of the noise that motion must stand out of, over what the tuning assumes.
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
  ModelMisfit misfit_;                ///< of the last closed block
  std::vector<double> misfit_error_;  ///< internal order, relative to theta0
  std::vector<double> prior_;
  std::vector<double> centre_, doubt_;  ///< of the prior: hold()
  std::vector<int> same_as_;            ///< FloorRows::same_as of a building of groups
  std::vector<double> share_error_;     ///< FloorRows::share_error, likewise
  /// Of every floor: kWarm when its rows fill most of the window, kRowless when it has none there.
  static constexpr std::uint8_t kFilling = 0, kWarm = 1, kRowless = 2;
  std::vector<std::uint8_t> warm_;
  std::vector<std::uint8_t> known_;        ///< Situation::known when last seen
  std::vector<std::uint8_t> place_known_;  ///< of every unknown: all motion it needs
  bool errors_known_ = false;
  bool solved_ = false;
  bool noise_known_ = false;  ///< Trust::noise_known of the last solution
  bool fresh_ = true;         ///< the noise level is that of other rows or of none
  /// More noise was subtracted than the window holds: its numbers mean nothing.
  bool overcompensated_ = false;
  double residual_energy_ = 0;
  double noise_scale_ = 0;  ///< residual energy over what sensor noise explains
  double noise_level_ = 0;  ///< the same of the last closed block
};

}  // namespace framewatch::estimator
