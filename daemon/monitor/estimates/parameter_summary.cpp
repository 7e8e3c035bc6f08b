// SPDX-License-Identifier: MIT
#include "daemon/monitor/estimates/parameter_summary.h"

#include <algorithm>
#include <cmath>

#include "estimator/numeric/nan.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::daemon {
namespace {

constexpr double kSameBending = 0.15;  // relative

/// Returns the index of krx for kx_1to6 and cx_1to6; the size of the table if it has no krx.
std::size_t bending_of(const parameter_table_t& table, std::size_t p) {
  if (p >= table.kind.size()) return table.name.size();
  const int kind = table.kind[p];
  const bool of_frames = kind == static_cast<int>(estimator::ParameterKind::frame_stiffness) ||
                         kind == static_cast<int>(estimator::ParameterKind::frame_damping);
  if (!of_frames || table.name[p].size() < 2) return table.name.size();
  const std::string name = std::string("kr") + table.name[p][1];
  return static_cast<std::size_t>(std::find(table.name.begin(), table.name.end(), name) -
                                  table.name.begin());
}

}  // namespace

std::vector<std::uint8_t> settled_windows(const SessionEstimates& s, std::size_t p) {
  std::vector<std::uint8_t> out(s.windows(), 1);
  const std::size_t bending = bending_of(s.table, p);
  if (bending == s.table.name.size()) return out;
  const std::vector<double>& held = s.value[bending];
  const double known = last_value(s, bending);
  if (std::isnan(known)) return out;
  for (std::size_t w = 0; w < out.size(); ++w)
    out[w] = std::abs(held[w] / known - 1) < kSameBending ? 1 : 0;
  return out;
}

double last_value(const SessionEstimates& s, std::size_t p) {
  const std::vector<double>& all = s.value[p];
  const auto last = std::find_if(all.rbegin(), all.rend(), [](double v) { return v > 0; });
  return last == all.rend() ? estimator::kNaN : *last;
}

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
