#pragma once

#include <cstddef>
#include <vector>

#include "daemon/monitor/estimates/session_estimates.h"
#include "estimator/identify/estimate/boxplot.h"

namespace framewatch::daemon {

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
