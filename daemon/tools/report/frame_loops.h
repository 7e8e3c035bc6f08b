#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "daemon/tools/report/session_motion.h"

namespace framewatch::daemon {

/// Story drift and restoring force (with damping) of one frame in one story, or of all frames of a
/// direction where rigid floors hide what each of them takes.
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
  std::string reason;  ///< why there are none; empty when there are
};

/// The strongest `seconds` of rows from..to-1 of the motion, in a 1.5 times longer stretch whose
/// ends are tapered away; displacements are accelerations integrated twice in the frequency domain
/// above high_pass_hz, and the forces see the same filter. A frame's force is its floors' inertia
/// above less what the panels give its neighbors; theta (SI, table order, NaN: not known) has the
/// panels.
FrameLoops frame_loops(const estimator::Structure& structure, const SessionMotion& motion,
                       const Eigen::VectorXd& theta, double high_pass_hz, double seconds,
                       Eigen::Index from, Eigen::Index to);

}  // namespace framewatch::daemon
