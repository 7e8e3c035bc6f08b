// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "estimator/identify/estimate/estimate.h"
#include "estimator/identify/groups/floor_motion.h"
#include "estimator/motion/derivative_triple.h"
#include "estimator/motion/sample.h"
#include "estimator/numeric/nan.h"
#include "estimator/setup/pipeline_config.h"
#include "estimator/structure/group_design.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// The knowledge of a building at the time its drift was computed. story_drifts() derives the
/// errors of the drift from it.
struct DriftKnowledge {
  /// By axis, m/s^2/sqrt(Hz), configured or measured; empty: as configured.
  std::vector<double> noise_density = {};
  std::vector<double> theta =
      {};  ///< table order, SI; NaN: not identified; empty: nothing identified
  std::vector<double> std_error = {};  ///< of theta, relative; NaN: not identified
  /// rms residual over rms response of the strongest window of the last minutes; NaN: not known.
  double misfit = kNaN;
};

/// Computes the elastic part of the story drifts that double integration above a corner removes.
/// The floors' slow accelerations times their masses are the slow story forces, which the
/// identified stiffness turns into drift. docs/equations.md (58), (59). It does not include
/// permanent drift.
class SlowDrift {
 public:
  /// Relative change of a stiffness that recomputes the flexibility.
  static constexpr double kFar = 0.02;

  /// Precondition: problems(config) is empty.
  explicit SlowDrift(const PipelineConfig& config);

  /// Takes over the parameters of a valid main window. Costs at most one solution of K.
  void follow(const WindowEstimate& estimate);
  /// Returns true once every frame's stiffness has been identified. Always false in a building
  /// driven by a shaker, whose force is not a floor's mass times its acceleration.
  bool known() const { return flexibility_.size() > 0; }
  /// Takes one instant. slow_accel: absolute accelerations of the frames on the floors
  /// (Structure::dof) behind the complement of the integrator's high-pass, m/s^2; NaN: not known.
  /// Returns the slow drift of every frame in every story, m; NaN if it or one of the accelerations
  /// is not known.
  const Eigen::VectorXd& push(const Eigen::VectorXd& slow_accel);
  /// Returns the knowledge without the noise of the sensors.
  DriftKnowledge knowledge() const;

  void archive(auto& a) {
    a(theta_, std_error_);
    a.each_within(identified_, 0, 1);
    a(misfit_, strongest_m2_, newest_);
    archive_flexibility(a);
    a.finite(static_before_);
    a(drift_);
  }

 private:
  void follow_misfit(const WindowEstimate& estimate);
  /// Archives the parameters of the flexibility, which may be older than theta_.
  void archive_flexibility(auto& a) {
    std::vector<double> formed(formed_.begin(), formed_.end());
    a.any_size(formed);
    if (a.kReading) {
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
  bool driven_;  ///< driven by a force
  std::vector<double> theta_, std_error_;
  std::vector<std::uint8_t> identified_;
  double misfit_ = kNaN, strongest_m2_ = 0;
  Time newest_{};
  Eigen::VectorXd formed_;       ///< theta that flexibility_ was computed with
  Eigen::MatrixXd flexibility_;  ///< drifts x accelerations, s^2; empty: not known
  double lag_ = 0;               ///< damping over stiffness, in half samples
  Eigen::VectorXd static_before_, drift_;
};

/// Computes FloorMotion with the parameters identified last and the channels that have values.
class EveryFloor {
 public:
  static constexpr double kFar = 0.1;   ///< relative change of a stiffness that is taken over
  static constexpr double kAway_s = 2;  ///< a channel without values for so long is left out

  /// Precondition: config.parameters().grouped(). settling: instants for which the motion by new
  /// stiffnesses runs beside the old one after its start is forgotten.
  EveryFloor(const PipelineConfig& config, std::int64_t settling);

  /// Returns FloorMotion::push(); NaN after a channel disappeared or returned, until the start is
  /// forgotten.
  const Eigen::VectorXd& push(const SampleSet& set);
  /// Returns the motion by the stiffnesses that will replace those in use; null: no replacement.
  const Eigen::VectorXd* coming() const { return coming_in_ > 0 ? &coming_accel_ : nullptr; }
  bool began() const { return began_; }      ///< coming() began with the last push()
  bool swapped() const { return swapped_; }  ///< the replacement took over at the last push()
  /// Takes over stiffnesses that differ from those in use by more than kFar. The motion uses the
  /// old ones until the start of the new ones is forgotten, so no peak is missed. Costs at most one
  /// FloorMotion::tune().
  void follow(const WindowEstimate& estimate);

  void archive(auto& a) {
    a(motion_, coming_);
    a.within(unsettled_, 0, a.kMaxCount);
    for (std::int64_t* count : {&coming_in_, &coming_unsettled_}) a.within(*count, 0, a.kMaxCount);
    a.each_within(away_, 0, a.kMaxCount);
  }

 private:
  bool follow_channels(const SampleSet& set);
  void push_coming(const SampleSet& set);

  FloorMotion motion_;
  FloorMotion coming_;  ///< replaces motion_ in coming_in_ instants
  std::int64_t settling_;
  std::int64_t coming_in_ = 0, coming_unsettled_ = 0;  ///< coming_in_ 0: no replacement
  Eigen::VectorXd coming_accel_;
  bool began_ = false, swapped_ = false;
  std::size_t elements_;
  std::vector<std::uint8_t> used_;  ///< 1: not for a check
  double away_rows_;
  std::vector<double> away_;  ///< instants without a value, by axis
  std::int64_t unsettled_ = 0;
  Eigen::VectorXd unknown_;
};

/// Computes the motion of the stories, one instant after the other. Displacements are accelerations
/// less their mean through one oscillator section at the estimation's high-pass (docs/equations.md
/// 8, 12); they are known two of its periods after the sensor's last interruption. SlowDrift adds
/// the slow drift that the section removes, once the stiffness is known. EveryFloor supplies the
/// motion of floors without sensors.
class StoryResponse {
 public:
  static constexpr double kDamping = 0.7;  ///< of the oscillator section, a ratio

  explicit StoryResponse(const PipelineConfig& config);

  /// Takes one calibrated instant.
  void push(const SampleSet& set);
  /// Takes over the identified parameters, which move floors without sensors from now on.
  void follow(const WindowEstimate& estimate);

  /// Returns the acceleration of each axis without its mean, m/s^2; NaN: no value.
  const std::vector<double>& accel_mps2() const { return accel_; }
  /// Returns the acceleration of a frame on a floor, 0: the base, m/s^2; NaN: not known. Includes
  /// the mean if floors have no sensors.
  double floor_accel_mps2(int floor, int frame) const;
  /// Returns the drift of each frame in each story (Structure::dof), m, positive toward +x or +y;
  /// NaN: not known.
  const std::vector<double>& drift_m() const { return drift_; }
  /// Returns the part of drift_m() that SlowDrift added, m; NaN: not known and not added.
  const std::vector<double>& slow_m() const { return slow_; }
  /// Returns true at the first instant after an interruption.
  bool interrupted() const { return interrupted_; }
  double rate_hz() const { return rate_hz_; }
  /// Returns the stiffness used for the last instant, without the sensors' noise.
  DriftKnowledge knowledge() const { return slow_drift_.knowledge(); }
  /// Returns the base shear along x and y, minus the floors' masses times their accelerations, N;
  /// NaN: not known.
  const std::array<double, 2>& base_shear_n() const { return base_shear_; }
  /// Returns how long displacements are not known after an interruption.
  double settling_s() const { return settling_ * step_s_; }

  void archive(auto& a) {
    a(next_index_, motions_, coming_motions_, slow_drift_);
    if (floors_) a(*floors_);
  }

 private:
  /// s: displacement above the corner, w^2 times; v: velocity, w times.
  struct Motion {
    double mean = 0, x1 = 0, x2 = 0, s1 = 0, s2 = 0, v1 = 0, v2 = 0;
    double seen = 0;     ///< instants in the mean
    double settled = 0;  ///< instants since the last interruption

    void archive(auto& a) {
      a.finite(mean, x1, x2, s1, s2, v1, v2, settled);
      a.within(seen, 0, a.kMaxCount);
    }
  };
  void advance(Motion& motion, double accel) const;
  void follow(std::size_t motion, double accel);
  void follow_floors(const SampleSet& set);
  /// The motion of a frame at a level, 0: the base.
  struct At {
    double accel_mps2, moved_m;
    double slow_mps2 = kNaN;  ///< of the floors: acceleration behind the high-pass' complement
  };
  At at(int level, int frame) const;
  At base(Direction direction) const;
  void find_story_motion();

  Structure structure_;
  std::vector<SensorAxis> axes_;
  double rate_hz_;
  OscillatorSection section_;
  double velocity_gain_;              ///< of Motion::v
  double over_w2_;                    ///< s^2
  double mean_step_;                  ///< of the mean's filter
  double settling_;                   ///< instants
  double step_s_;                     ///< between instants
  std::optional<EveryFloor> floors_;  ///< empty if every frame has a sensor on every floor
  std::vector<int> motion_of_dof_;    ///< -1: no sensor
  std::int64_t next_index_ = -1;
  std::vector<Motion> motions_;         ///< by axis; then by level and frame
  std::vector<Motion> coming_motions_;  ///< by level and frame: by EveryFloor::coming()
  std::vector<double> late_s_;          ///< of the axes: the delay beyond whole samples
  std::vector<double> motion_accel_, moved_, slow_accel_;  ///< of motions_; moved_: displacement, m
  std::vector<double> accel_;                              ///< by axis
  Eigen::VectorXd floor_accel_;  ///< of floors_, by level and frame, with its mean
  SlowDrift slow_drift_;
  Eigen::VectorXd slow_floors_;  ///< Structure::dof
  std::vector<double> drift_, slow_;
  bool interrupted_ = false;
  std::array<double, 2> base_shear_{kNaN, kNaN};
};

}  // namespace framewatch::estimator
