// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "daemon/monitor/estimates/session_estimates.h"
#include "estimator/identify/estimate/boxplot.h"

namespace framewatch::daemon {

/// Returns by window whether the parameter's value there is comparable with the others. Stiffness
/// and bending of frames that bend (krx, kry) go together: such a stiffness is comparable only
/// where it was identified with about the final bending stiffness. In a first record the bending is
/// still being identified.
std::vector<std::uint8_t> settled_windows(const SessionEstimates& session, std::size_t parameter);

/// Returns the newest value, SI; NaN if the parameter has no value yet.
double last_value(const SessionEstimates& session, std::size_t parameter);

/// Statistics of one parameter over the comparable windows (settled_windows()) of a range.
struct ParameterSummary {
  double mean = 0;              ///< of the windows with a value, SI; NaN if none has one
  double std_error = 0;         ///< of one window: root mean square of the published ones
  double observable_ratio = 0;  ///< share of the windows that have such a value
  estimator::BoxplotStatistics boxplot{};
  std::vector<double> outliers;
};
ParameterSummary summarise(const SessionEstimates& session, std::size_t parameter,
                           WindowRange windows);

}  // namespace framewatch::daemon
