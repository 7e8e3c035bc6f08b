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

/// Checks whether the corners of the row filters still match what was identified. When they do not,
/// it tunes a second regression, the standby, lets it catch up through the motion ring and
/// exchanges it for the active one. All of it in slices, a fixed amount of work per instant, in
/// memory taken at the start. docs/equations.md, retuning.
class SelfTuning {
 public:
  /// standby: equal to the active regression. fill: instants a motion needs to become valid.
  /// noise_known: see below, of the active regression.
  SelfTuning(const FloorLayout& layout, const ParameterTable& table,
             std::unique_ptr<TunedRegression> standby, int blocks, int fill, bool noise_known);

  /// Exchanges `active` for a regression that is tuned to this; before() is then the former one. To
  /// be called before the first instant.
  void start_tuned(std::unique_ptr<TunedRegression>& active, const Tuning& tuning);

  /// Instants the ring must hold for a regression that needs `warm_up` of them.
  static int ring_rows(int warm_up) { return 2 * warm_up + 2; }

  /// The input was interrupted: a re-tuning under way is abandoned.
  void restart() {
    phase_ = Phase::idle;
    lending_ = false;
  }
  bool idle() const { return phase_ == Phase::idle; }
  /// Once per completed pass of batch means: whether the filters should be checked now. Every time
  /// until they were found right, then once a window.
  bool due();
  /// Begins a check. ratio, std_error: of the window's solution, internal order, relative to
  /// theta0; shown: whether the window shows the unknown. noise: when rows are weighted by another
  /// one, they are formed anew.
  void begin_check(const TunedRegression& active, const std::vector<double>& ratio,
                   const std::vector<double>& std_error, const std::vector<std::uint8_t>& shown,
                   const AxisNoise& noise);
  /// Begins a tuning to other axes.
  void begin_axes(const TunedRegression& active, const std::vector<std::uint8_t>& present,
                  const RowTuning::Known& known);
  /// Tunes the standby as the active regression is, and lends it: until give_back() it is not used
  /// for tuning.
  void lend(const TunedRegression& active);
  /// The standby while it is lent and tuned, otherwise null.
  TunedRegression* lent() { return phase_ == Phase::lent ? standby_.get() : nullptr; }
  void give_back() { restart(); }
  /// Instants a regression can take in per instant of input.
  int work_per_instant() const { return catch_up_per_instant_; }
  /// One instant's share of the work. True when `active` was exchanged for the newly tuned
  /// regression; before() is then the former one.
  bool step(std::unique_ptr<TunedRegression>& active, const MotionRing& ring);
  const TunedRegression& before() const { return *standby_; }
  TunedRegression& standby() { return *standby_; }

  /// The noise by which the active regression weights its rows is known, of every axis.
  bool noise_known() const { return noise_known_; }
  /// A check has found the filters right.
  bool tuned() const { return tuned_; }
  std::int64_t retunes() const { return retunes_; }

  template <typename Archive>
  void archive(Archive& a) {
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
  bool lending_ = false;  ///< what is being tuned is to be lent
  int next_part_ = 0, passes_ = 0, since_check_ = 0;
  double detuning_ = 0;
  bool noise_known_;
  bool noise_measured_ = false;  ///< noise_ is known of every axis
  bool noise_differs_ = false;
  std::vector<double> noise_;
  std::int64_t retunes_ = 0;
  RetuningWork work_;
  Eigen::VectorXd next_theta0_;
};

}  // namespace framewatch::estimator
