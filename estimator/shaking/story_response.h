#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "estimator/identify/estimate/estimate.h"
#include "estimator/motion/derivative_triple.h"
#include "estimator/motion/sample.h"
#include "estimator/numeric/nan.h"
#include "estimator/setup/pipeline_config.h"
#include "estimator/shaking/every_floor.h"
#include "estimator/shaking/slow_drift.h"
#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// The motion of the stories at one instant after the other. Displacements are accelerations less
/// their mean through one oscillator section at the estimation's high-pass (docs/equations.md 8,
/// 12); they are known two of its periods after the sensor's last interruption. The slow drift that
/// the section removes is added from SlowDrift once the stiffness is known. Where floors have no
/// sensors of their own, their motion is that of EveryFloor.
class StoryResponse {
 public:
  static constexpr double kDamping = 0.7;  ///< of the oscillator section, a ratio

  explicit StoryResponse(const PipelineConfig& config);

  /// One calibrated instant.
  void push(const SampleSet& set);
  /// What was identified: floors without sensors move by it from now on.
  void follow(const WindowEstimate& estimate);

  /// Of each axis: without its mean, m/s^2; NaN: none.
  const std::vector<double>& accel_mps2() const { return accel_; }
  /// Of a frame on a floor, 0: the base, m/s^2; NaN: not known. Without its mean where every frame
  /// has a sensor.
  double floor_accel_mps2(int floor, int frame) const;
  /// Of each frame in each story (Structure::dof), m, positive toward +x or +y; NaN: not known.
  const std::vector<double>& drift_m() const { return drift_; }
  /// The part of drift_m() that SlowDrift added, m; NaN: not known, drift_m() is without it.
  const std::vector<double>& slow_m() const { return slow_; }
  /// True at the first instant after instants that never came.
  bool interrupted() const { return interrupted_; }
  double rate_hz() const { return rate_hz_; }
  /// What the stiffness was when the last instant was pushed; without the sensors' noise.
  DriftKnowledge knowledge() const { return slow_drift_.knowledge(); }
  /// Along x and y: minus the floors' masses times their accelerations, N; NaN: not known.
  const std::array<double, 2>& base_shear_n() const { return base_shear_; }
  /// Displacements are not known for so long after an interruption.
  double settling_s() const { return settling_ * step_s_; }

  template <typename Archive>
  void archive(Archive& a) {
    a(next_index_, motions_, coming_motions_, slow_drift_);
    if (floors_) a(*floors_);
  }

 private:
  /// s: displacement above the corner, w^2 times; v: velocity, w times.
  struct Motion {
    double mean = 0, x1 = 0, x2 = 0, s1 = 0, s2 = 0, v1 = 0, v2 = 0;
    double seen = 0;     ///< instants in the mean
    double settled = 0;  ///< instants since the last interruption

    template <typename Archive>
    void archive(Archive& a) {
      a.finite(mean, x1, x2, s1, s2, v1, v2, settled);
      a.within(seen, 0, Archive::kMaxCount);
    }
  };
  void advance(Motion& motion, double accel) const;
  void follow(std::size_t motion, double accel);
  void follow_floors(const SampleSet& set);
  /// Of a frame at a level, 0: the base.
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
  std::optional<EveryFloor> floors_;  ///< none where every frame has a sensor on every floor
  std::vector<int> motion_of_dof_;    ///< -1: none
  std::int64_t next_index_ = -1;
  std::vector<Motion> motions_;         ///< by axis; then by level and frame
  std::vector<Motion> coming_motions_;  ///< by level and frame: by EveryFloor::coming()
  std::vector<double> late_s_;          ///< of the axes: delay that is less than a sample
  std::vector<double> motion_accel_, moved_, slow_accel_;  ///< of motions_; moved_: displacement, m
  std::vector<double> accel_;                              ///< by axis
  Eigen::VectorXd floor_accel_;  ///< of floors_, by level and frame: as they move, mean and all
  SlowDrift slow_drift_;
  Eigen::VectorXd slow_floors_;  ///< Structure::dof
  std::vector<double> drift_, slow_;
  bool interrupted_ = false;
  std::array<double, 2> base_shear_{kNaN, kNaN};
};

/// The largest of it in a time, absolute; NaN: never known.
struct PeakResponse {
  static constexpr double kLately_s = 2;  ///< memory of lately_mps2, which decays with it

  std::vector<double> accel_mps2;                  ///< of each axis
  std::vector<double> drift_m;                     ///< of each frame in each story (Structure::dof)
  std::array<double, 2> base_shear_n{kNaN, kNaN};  ///< along x and y
  /// Of drift_m, at its peak: StoryResponse::slow_m(), of the peak's sign; NaN: was not known.
  std::vector<double> slow_m;
  /// By frame in each story, then axis: the largest acceleration of the axis while the drift was
  /// not known; NaN: it always was. Before instants that never came lately_mps2 counts.
  std::vector<double> unseen_mps2;
  std::vector<double> lately_mps2;  ///< of each axis, in the last seconds

  PeakResponse() = default;
  PeakResponse(std::size_t axes, std::size_t degrees_of_freedom)
      : accel_mps2(axes, kNaN),
        drift_m(degrees_of_freedom, kNaN),
        slow_m(degrees_of_freedom, kNaN),
        unseen_mps2(axes * degrees_of_freedom, kNaN),
        lately_mps2(axes, 0),
        before_m_(3 * degrees_of_freedom, kNaN) {}
  void take(const StoryResponse& response);

  template <typename Archive>
  void archive(Archive& a) {
    a(accel_mps2, drift_m, base_shear_n, slow_m, unseen_mps2, before_m_);
    a.each_within(lately_mps2, 0, a.kMax);
  }

 private:
  void take_drift(std::size_t dof, double drift, double slow);
  void note_unseen(std::size_t dof, const std::vector<double>& accel);

  /// By frame in each story: drift two instants ago, one ago, and the slow part one ago.
  std::vector<double> before_m_;
};

/// Story drift over story height, of the frame that drifted most.
struct PeakDrift {
  double ratio = kNaN;
  int frame = -1;  ///< -1: of none it is known
};
/// story: from 1.
PeakDrift peak_drift(const PeakResponse& peak, const Structure& structure, int story);
/// Whether the drift of a story is that of channels on its floor and on the one below; else it is
/// computed, with the motion that the identified model gives floors without.
bool drift_is_measured(const PipelineConfig& config, int story);
/// Of all stories; 0 where none is known.
double largest_drift_ratio(const PeakResponse& peak, const Structure& structure);
/// Of the axes at a level, 0: the base; NaN: of none it is known.
double peak_accel_mps2(const PeakResponse& peak, const std::vector<SensorAxis>& axes, int level);

}  // namespace framewatch::estimator
