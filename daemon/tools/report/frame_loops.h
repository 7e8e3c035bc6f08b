// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "daemon/tools/report/session_motion.h"

namespace framewatch::daemon {

/// Story drift and restoring force (with damping) of one frame in one story. With rigid floors,
/// which hide the share of each frame, it is that of all frames of a direction.
struct FrameLoop {
  std::string name;  ///< parameter name, or "story 1, x"
  int story = 0;
  int parameter = -1;  ///< index in the table of the frame's stiffness; -1: all frames together
  std::vector<double> drift_m;
  std::vector<double> force_n;
  double largest_drift_m = 0;  ///< absolute, over the stretch
};

struct FrameLoops {
  std::int64_t from_us = 0, to_us = 0;  ///< sensor time of what is shown
  std::vector<FrameLoop> loops;
  std::string reason;  ///< why there are no loops; empty when there are
};

/// Computes the loops of the strongest `seconds` of rows from..to-1 of the motion.
///
/// The stretch is 1.5 times longer, and its ends are tapered away. Displacements are accelerations
/// integrated twice in the frequency domain above high_pass_hz; the forces pass the same filter. A
/// frame's force is the inertia of the floors above it, less what the panels give its neighbors.
/// theta: SI, table order, NaN for unknown; the panels' stiffnesses are taken from it.
FrameLoops frame_loops(const estimator::Structure& structure, const SessionMotion& motion,
                       const Eigen::VectorXd& theta, double high_pass_hz, double seconds,
                       Eigen::Index from, Eigen::Index to);

}  // namespace framewatch::daemon
