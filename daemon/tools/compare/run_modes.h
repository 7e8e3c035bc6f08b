// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/tools/report/session_report.h"
#include "estimator/modes/natural_modes.h"
#include "estimator/watch/change_point.h"

namespace framewatch::daemon {

/// A natural mode of a run's model, and what its samples alone show of it.
struct RunMode {
  estimator::NaturalMode natural;                            ///< errors are 0 for a design
  double measured_hz, measured_damping_ratio, mac_measured;  ///< NaN: not measured
};

struct RunModes {
  std::vector<RunMode> modes;  ///< by ascending frequency
  std::string none;            ///< reason for an empty list
};

/// Returns the modes of a run: of the model refined from its samples, after a change if there is
/// one. Without such a model they are those of `values`, whose errors count as independent; the
/// design stands for a value that is missing, with the usual error of a design.
/// values: by parameter of the report's table, SI.
RunModes run_modes(const SessionReport& report, const std::vector<estimator::WindowMean>& values);

/// Returns the modes in the form that paired_modes() compares, at all degrees of freedom.
std::vector<estimator::ComparedMode> compared_modes(const std::vector<RunMode>& modes);

}  // namespace framewatch::daemon
