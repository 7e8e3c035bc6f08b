#include "daemon/monitor/estimates/parameter_summary.h"

#include <cmath>
#include <cstdint>

#include "daemon/monitor/estimates/settled_windows.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {

ParameterSummary summarise(const SessionEstimates& session, std::size_t parameter,
                           WindowRange windows) {
  ParameterSummary out;
  std::vector<double> values;
  double sum = 0, squares = 0;
  const std::vector<std::uint8_t> settled = settled_windows(session, parameter);
  for (std::size_t w = windows.from; w < windows.to; ++w) {
    const double value = session.value[parameter][w], error = session.std_error[parameter][w];
    if (settled[w] == 0 || !std::isfinite(value)) continue;
    values.push_back(value);
    sum += value;
    squares += error * error;
  }
  const auto count = static_cast<double>(values.size());
  out.mean = values.empty() ? estimator::kNaN : sum / count;
  out.std_error = values.empty() ? estimator::kNaN : std::sqrt(squares / count);
  out.observable_ratio = windows.size() > 0 ? count / static_cast<double>(windows.size()) : 0;
  out.boxplot = boxplot_of(values);
  for (const double value : values)
    if (value < out.boxplot.whisker_low || value > out.boxplot.whisker_high)
      out.outliers.push_back(value);
  return out;
}

}  // namespace framewatch::daemon
