// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "estimator/identify/elements/guessed_design.h"
#include "estimator/identify/noise/axis_noise.h"
#include "estimator/identify/window/tuned_regression.h"
#include "estimator/setup/pipeline_config.h"

namespace framewatch::estimator {

/// Checks if the corner frequencies of the row filters still match the identified parameters. If
/// not, it tunes a second regression, the standby, lets it catch up through the motion ring, and
/// exchanges it for the active one. Each instant does a fixed amount of work. Memory is allocated
/// only in the constructor. docs/equations.md, retuning.
class SelfTuning {
 public:
  /// standby: equal to the active regression. fill: instants that a motion needs to become valid.
  /// noise_known: see noise_known(), for the active regression.
  SelfTuning(const FloorLayout& layout, const ParameterTable& table,
             std::unique_ptr<TunedRegression> standby, int blocks, int fill, bool noise_known);

  /// Exchanges `active` for a regression with this tuning; before() then returns the former one.
  /// Call it before the first instant.
  void start_tuned(std::unique_ptr<TunedRegression>& active, const Tuning& tuning);

  /// Returns the instants that the ring must hold for a regression that needs `warm_up` of them.
  static int ring_rows(int warm_up) { return 2 * warm_up + 2; }

  /// Abandons a retuning in progress after an interruption of the input.
  void restart() {
    phase_ = Phase::idle;
    lending_ = false;
  }
  bool idle() const { return phase_ == Phase::idle; }
  /// Returns true if the filters should be checked now: at every call until they match, then once
  /// per window. Call it once per completed pass of batch means.
  bool due();
  /// Begins a check. ratio, std_error: of the window's solution, internal order, relative to
  /// theta0. shown: flags of the unknowns that the window shows. noise: if its ratios have changed,
  /// the rows are weighted and formed anew.
  void begin_check(const TunedRegression& active, const std::vector<double>& ratio,
                   const std::vector<double>& std_error, const std::vector<std::uint8_t>& shown,
                   const AxisNoise& noise);
  /// Begins a tuning to other axes.
  void begin_axes(const TunedRegression& active, const std::vector<std::uint8_t>& present,
                  const RowTuning::Known& known);
  /// Tunes the standby as the active regression is tuned, and lends it. Until give_back(), it is
  /// not used for tuning.
  void lend(const TunedRegression& active);
  /// Returns the standby while it is lent and tuned, otherwise nullptr.
  TunedRegression* lent() { return phase_ == Phase::lent ? standby_.get() : nullptr; }
  void give_back() { restart(); }
  /// Returns the instants that a regression can take in per instant of input.
  int work_per_instant() const { return catch_up_per_instant_; }
  /// Does one instant's share of the work. Returns true if `active` was exchanged for the retuned
  /// regression; before() then returns the former one.
  bool step(std::unique_ptr<TunedRegression>& active, const MotionRing& ring);
  const TunedRegression& before() const { return *standby_; }
  TunedRegression& standby() { return *standby_; }

  /// Returns true if the noise that weights the active regression's rows is known for every axis.
  bool noise_known() const { return noise_known_; }
  /// Returns true if a check has found that the filters match.
  bool tuned() const { return tuned_; }
  std::int64_t retunes() const { return retunes_; }

  void archive(auto& a) {
    a(*standby_, tuned_, noise_known_, noise_measured_, noise_differs_);
    a(lending_);
    a.within(phase_, 0, static_cast<double>(Phase::lent));
    if (phase_ == Phase::catching_up && standby_->resting()) a.refuse();
    for (int* number : {&next_part_, &passes_, &since_check_}) a.within(*number, 0, a.kMaxCount);
    a.within(retunes_, 0, a.kMaxCount);
    a.finite(detuning_, noise_, next_theta0_);
  }

 private:
  enum class Phase { idle, checking, tuning, catching_up, lent };
  /// Begins to tune the standby to these axes and parameters. It forms no rows until its start().
  void begin_tuning(const std::vector<std::uint8_t>& axes, const RowTuning::Known& ratios,
                    const Eigen::VectorXd& theta0, const std::vector<double>& noise_density);
  void check_floors(TunedRegression& active);
  void tune_parts(const MotionRing& ring);
  bool catch_up(const TunedRegression& active, const MotionRing& ring);

  FloorLayout layout_;
  ParameterTable table_;
  std::unique_ptr<TunedRegression> standby_;
  int blocks_, fill_, parts_per_instant_, catch_up_per_instant_;
  Phase phase_ = Phase::idle;
  bool tuned_ = false;
  bool lending_ = false;  ///< the standby is being tuned to be lent
  int next_part_ = 0, passes_ = 0, since_check_ = 0;
  double detuning_ = 0;
  bool noise_known_;
  bool noise_measured_ = false;  ///< noise_ holds the measured noise of every axis
  bool noise_differs_ = false;
  std::vector<double> noise_;
  std::int64_t retunes_ = 0;
  RetuningWork work_;
  Eigen::VectorXd next_theta0_;
};

}  // namespace framewatch::estimator
