#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "daemon/monitor/estimates/session_estimates.h"
#include "estimator/identify/estimate/boxplot.h"

namespace framewatch::daemon {

/// By window, whether the parameter's value there can be compared with the others: those of frames
/// that bend only where they were identified with about the bending stiffness (krx, kry) that was
/// known in the end, because the two go together. A first record finds the bending on its way.
std::vector<std::uint8_t> settled_windows(const SessionEstimates& session, std::size_t parameter);

/// The newest value, SI; NaN: there is none.
double last_value(const SessionEstimates& session, std::size_t parameter);

/// One parameter over some windows, those that can be compared with the others (settled_windows()).
struct ParameterSummary {
  double mean = 0;              ///< of the windows with a value, SI; NaN: none has
  double std_error = 0;         ///< of one window: root mean square of the published ones
  double observable_ratio = 0;  ///< of the windows that have such a value
  estimator::BoxplotStatistics boxplot{};
  std::vector<double> outliers;
};
ParameterSummary summarise(const SessionEstimates& session, std::size_t parameter,
                           WindowRange windows);

}  // namespace framewatch::daemon
