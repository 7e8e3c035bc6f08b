// SPDX-License-Identifier: MIT
#pragma once

#include "estimator/setup/pipeline_config.h"

namespace framewatch::estimator {

/// The memory of a Pipeline in bytes, computed from its configuration before it is made. Each part
/// names the options that it grows with.
struct PipelineSize {
  double sums = 0;      ///< of the windows: stories, frames, window lengths, rate_hz
  double solvers = 0;   ///< stories, frames, number of windows
  double motion = 0;    ///< kept for re-tuning: window lengths, settle_s, high_pass_hz, rate_hz
  double noise = 0;     ///< impulse responses: rate_hz over high_pass_hz
  double boxplots = 0;  ///< parameters, boxplot_windows
  double open = 0;      ///< instants that wait for samples: axes, lateness_s, rate_hz

  /// Returns the sum of the parts.
  double bytes() const { return sums + solvers + motion + noise + boxplots + open; }
};

/// Returns the size of a Pipeline. Precondition: problems(config) is empty. The sum is within a
/// third of what a pipeline of over 4 MB then takes.
PipelineSize pipeline_size(const PipelineConfig& config);

}  // namespace framewatch::estimator
