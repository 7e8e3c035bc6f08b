#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "estimator/motion/motion_filter.h"
#include "estimator/simulate/simulated_building.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/structure.h"
#include "estimator/watch/gap.h"

namespace framewatch {

/// A model that moves with the building, under its measured base motion. Between the samples the
/// base motion is that of their band: a windowed sinc at steps of 1 ms at most. Its floors'
/// accelerations see drift control and filter as measured ones do, but the base does not: laws are
/// not linear.
class RunningModel {
 public:
  /// late: of the base's samples (x, y), less than an instant, in instants.
  RunningModel(const Structure& structure, const ParameterTable& table, const GapModel& model,
               double rate_hz, double high_pass_hz, const Eigen::Vector2d& late = {0, 0});

  /// At rest, and the base has been.
  void restart();
  /// Absolute acceleration of the base (x, y) at the next instant, m/s^2.
  void push(const Eigen::Vector2d& base);
  /// Filtered absolute acceleration of a degree of freedom (Structure::dof), m/s^2: what a sensor
  /// there and a MotionFilter give kDelay instants before the newest.
  double accel_abs(int dof) const { return filter_.value(dof); }
  /// Time after which nothing is left of how it began.
  double settle_s() const { return settle_s_; }

  static constexpr int kDelay = 16;  ///< instants

  template <typename Archive>
  void archive(Archive& a) {
    std::vector<double> motion = building_->motion();
    a(base_, newest_, bias_, before_, motion, filter_);
    if constexpr (Archive::kReading) {
      if (!building_->resume(motion)) restart();
    }
  }

 private:
  static constexpr int kTaps = 2 * kDelay + 1;
  static constexpr double kAfterEverything_s = 1e6;

  int steps_;  ///< per instant
  std::unique_ptr<SimulatedBuilding> building_;
  std::vector<double> rest_;  ///< its motion
  double settle_s_;
  using Taps = Eigen::Matrix<double, Eigen::Dynamic, kTaps>;
  static Taps taps(int steps, double late);
  Taps taps_x_, taps_y_;      ///< steps x instants, newest first
  std::vector<double> base_;  ///< ring of kTaps instants, x and y
  int newest_ = 0;
  double bias_share_;  ///< of a sample in the slow mean that is no motion
  Eigen::Vector2d bias_{0, 0};
  Eigen::Vector2d before_{0, 0};
  MotionFilter filter_;
  std::vector<double> unfiltered_;
};

}  // namespace framewatch
