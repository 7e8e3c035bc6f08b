// SPDX-License-Identifier: MIT
#include "daemon/monitor/estimates/estimate_series.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "estimator/numeric/nan.h"

namespace framewatch::daemon {

EstimateSeries::EstimateSeries(const estimator::ParameterTable& table, bool with_errors,
                               double min_snr)
    : with_errors_(with_errors), min_snr_(min_snr) {
  for (int i = 0; i < table.size(); ++i)
    parameters_.push_back({table[i].name, table[i].unit, table[i].kind, {}, {}, {}});
}

void EstimateSeries::add(const estimator::WindowEstimate& estimate) {
  end_us_.push_back(to_microseconds(estimate.end));
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    Series& series = parameters_[i];
    const bool observable = estimate.reason[i] == estimator::Observability::observable;
    series.value.push_back(observable ? estimate.value[i] : estimator::kNaN);
    if (with_errors_)
      series.std_error.push_back(
          static_cast<float>(observable ? estimate.std_error[i] : estimator::kNaN));
    const int reason = told_reason(static_cast<int>(estimate.reason[i]), estimate.snr[i], min_snr_);
    ++series.reasons.at(static_cast<std::size_t>(reason));
  }
}

EstimateSeries::Range EstimateSeries::range(std::int64_t from_us, std::int64_t to_us) const {
  const auto begin = std::lower_bound(end_us_.begin(), end_us_.end(), from_us);
  const auto end = std::upper_bound(begin, end_us_.end(), to_us);
  return {static_cast<std::size_t>(begin - end_us_.begin()),
          static_cast<std::size_t>(end - end_us_.begin())};
}

EstimateSeries::Quartiles EstimateSeries::quartiles(const Series& series, Range range) const {
  const auto at = [&](std::size_t i) { return series.value.begin() + std::ptrdiff_t(i); };
  std::vector<double> values(at(range.begin), at(range.end));
  const auto windows = static_cast<double>(values.size());
  std::erase_if(values, [](double v) { return std::isnan(v); });
  const double observable_ratio = static_cast<double>(values.size()) / windows;
  const auto [q1, median, q3] = quartiles_of(std::move(values));
  return {q1, median, q3, observable_ratio};
}

std::array<double, 3> quartiles_of(std::vector<double> values) {
  std::erase_if(values, [](double v) { return std::isnan(v); });
  std::array<double, 3> out;
  out.fill(estimator::kNaN);
  if (values.empty()) return out;
  auto from = values.begin();  // sorts only what the quartiles need
  for (std::size_t q = 0; q < out.size(); ++q) {
    const double position = std::clamp(0.25 * static_cast<double>((q + 1) * values.size()) - 0.5,
                                       0.0, static_cast<double>(values.size() - 1));
    const auto below = values.begin() + static_cast<std::ptrdiff_t>(position);
    std::nth_element(from, below, values.end());
    const auto above =
        below + 1 == values.end() ? below : std::min_element(below + 1, values.end());
    out[q] = *below + (position - std::floor(position)) * (*above - *below);
    from = below;
  }
  return out;
}

}  // namespace framewatch::daemon
