#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "estimator/identify/estimate/estimate.h"
#include "estimator/numeric/nan.h"
#include "estimator/setup/pipeline_config.h"
#include "estimator/structure/group_design.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::estimator {

/// What was known of a building when its drift was computed; the errors of the drift follow from it
/// (story_drifts()).
struct DriftKnowledge {
  /// By axis, m/s^2/sqrt(Hz), configured or measured; empty: as configured.
  std::vector<double> noise_density = {};
  std::vector<double> theta = {};      ///< table order, SI; NaN: not identified; empty: nothing is
  std::vector<double> std_error = {};  ///< of theta, relative; NaN: not identified
  /// rms residual over rms response of the strongest window of the last minutes; NaN: none.
  double misfit = kNaN;
};

/// The elastic part of the story drifts that double integration above a corner removes: the floors'
/// slow accelerations times their masses are the slow story forces, and the identified stiffness
/// turns these into drift. docs/equations.md (58), (59). It knows nothing of permanent drift.
class SlowDrift {
 public:
  /// Relative change of a stiffness from which on the flexibility is computed anew.
  static constexpr double kFar = 0.02;

  /// Precondition: problems(config) is empty.
  explicit SlowDrift(const PipelineConfig& config);

  /// Takes over what a valid main window shows. Bounded in time by one solution of K.
  void follow(const WindowEstimate& estimate);
  /// True once every frame's stiffness has been identified. False for ever in a building that a
  /// shaker drives, whose force is no floor's mass times its acceleration.
  bool known() const { return flexibility_.size() > 0; }
  /// slow_accel: absolute accelerations of the frames on the floors (Structure::dof) behind the
  /// complement of the integrator's high-pass, m/s^2; NaN: not known. Returns the slow drift of
  /// every frame in every story, m; NaN while it or one of the accelerations is not known.
  const Eigen::VectorXd& push(const Eigen::VectorXd& slow_accel);
  /// Without the noise of the sensors.
  DriftKnowledge knowledge() const;

  template <typename Archive>
  void archive(Archive& a) {
    a(theta_, std_error_);
    a.each_within(identified_, 0, 1);
    a(misfit_, strongest_m2_, newest_);
    archive_flexibility(a);
    a.finite(static_before_);
    a(drift_);
  }

 private:
  void follow_misfit(const WindowEstimate& estimate);
  /// The flexibility is of the stiffness it was computed with last, not of the newest.
  template <typename Archive>
  void archive_flexibility(Archive& a) {
    std::vector<double> formed(formed_.begin(), formed_.end());
    a.any_size(formed);
    if constexpr (Archive::kReading) {
      if (!formed.empty() && formed.size() != theta_.size()) return a.refuse();
      formed_.resize(0);
      flexibility_.resize(0, 0);
      if (formed.empty()) return;
      theta_.swap(formed);
      form();
      theta_.swap(formed);
    }
  }
  void form();
  double damping_lag_s() const;

  PipelineConfig config_;
  ParameterTable table_;
  GroupDesign design_;
  Eigen::VectorXd designed_;
  bool driven_;  ///< by a force
  std::vector<double> theta_, std_error_;
  std::vector<std::uint8_t> identified_;
  double misfit_ = kNaN, strongest_m2_ = 0;
  Time newest_{};
  Eigen::VectorXd formed_;       ///< theta that flexibility_ was computed with
  Eigen::MatrixXd flexibility_;  ///< drifts x accelerations, s^2; empty: not known
  double lag_ = 0;               ///< damping over stiffness, in half samples
  Eigen::VectorXd static_before_, drift_;
};

}  // namespace framewatch::estimator
