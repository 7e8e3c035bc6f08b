#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/motion/sample.h"
#include "estimator/structure/effect.h"

namespace framewatch {

/// What is simulated beside the measurement. Effects that begin at a time are there from the start;
/// forces from outside do not act.
struct GapModel {
  Eigen::VectorXd theta;  ///< in the order of the parameter table, SI
  std::vector<Effect> effects;
};

struct GapOptions {
  double window_s = 10;  ///< whole seconds
  double learn_s = 60;   ///< of windows that a model is learned from, when none is given
  /// What noise does not explain of the motion, relative, from which on a gap is one.
  double raise_ratio = 0.15;
  double lasting_s = 10;  ///< so long before it is believed, and before it is over
};

/// Simulation against measurement over one window: sqrt(sum (measured - simulated)^2 / sum
/// measured^2) of absolute accelerations, drift control and filter of the estimation alike, and the
/// least it can be with the sensors' noise.
struct GapWindow {
  Time start, end;
  double nrmse = 0;                                  ///< of all channels above the base
  double floor = 0;                                  ///< NaN while it is not known
  std::vector<double> channel_nrmse, channel_floor;  ///< of each axis; NaN: base, or no values

  template <typename Archive>
  void archive(Archive& a) {
    a(start, end, nrmse, floor, channel_nrmse, channel_floor);
  }
};

}  // namespace framewatch
