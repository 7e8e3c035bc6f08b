#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/motion/sample.h"
#include "estimator/structure/effect.h"

namespace framewatch::estimator {

/// The model that is simulated beside the measurement. Effects that begin at a time act from the
/// start; external forces do not act.
struct GapModel {
  Eigen::VectorXd theta;  ///< in the order of the parameter table, SI
  std::vector<Effect> effects;
};

struct GapOptions {
  double window_s = 10;  ///< whole seconds
  double learn_s = 60;   ///< total length of the windows to learn a model from, when none is given
  /// A gap is one when noise leaves more than this share of the motion unexplained.
  double raise_ratio = 0.15;
  double lasting_s = 10;  ///< time before a gap is accepted, and before it is over
};

/// The disagreement of simulation and measurement over one window: sqrt(sum (measured -
/// simulated)^2 / sum measured^2) of absolute accelerations, both behind the drift control and
/// filter of the estimation, and its floor, which the noise of the sensors explains.
struct GapWindow {
  Time start, end;
  double nrmse = 0;                            ///< of all axes above the base
  double floor = 0;                            ///< NaN while it is not known
  std::vector<double> axis_nrmse, axis_floor;  ///< of each axis; NaN: base, or no values

  template <typename Archive>
  void archive(Archive& a) {
    a(start, end, nrmse, floor, axis_nrmse, axis_floor);
  }
};

}  // namespace framewatch::estimator
