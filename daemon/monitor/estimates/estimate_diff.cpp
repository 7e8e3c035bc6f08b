// SPDX-License-Identifier: MIT
#include "daemon/monitor/estimates/estimate_diff.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "daemon/monitor/estimates/estimate_table.h"

namespace framewatch::daemon {
namespace {

/// Returns element `i` as a double, or NaN if `values` is shorter.
template <typename Value>
double entry(const std::vector<Value>& values, std::size_t i) {
  return i < values.size() ? static_cast<double>(values[i])
                           : std::numeric_limits<double>::quiet_NaN();
}

/// Returns the held values by parameter.
std::vector<double> held(const window_estimate_t& e, const std::vector<double>& values) {
  std::vector<double> out(static_cast<std::size_t>(e.parameters),
                          std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < e.held_index.size(); ++i) {
    const auto p = static_cast<std::size_t>(e.held_index[i]);
    if (p < out.size()) out[p] = values[i];
  }
  return out;
}

}  // namespace

double FieldDifference::ratio() const {
  if (std::isnan(a) != std::isnan(b)) return std::numeric_limits<double>::infinity();
  const double size = std::max(std::abs(a), std::abs(b));
  return size > 0 ? std::abs(a - b) / size : 0;
}

void EstimateDiff::note(const std::string& subject, const std::string& field, double a, double b) {
  if (std::memcmp(&a, &b, sizeof a) == 0) return;  // NaN equals NaN, 0 differs from -0
  same_ = false;
  DifferenceSpan& span = spans_[subject][field];
  const FieldDifference difference{channel_, field, end_us_, a, b};
  if (span.count++ == 0) span.first = difference;
  if (span.count == 1 || difference.ratio() > span.worst.ratio()) span.worst = difference;
}

template <typename Value>
void EstimateDiff::columns(const char* field, const std::vector<Value>& a,
                           const std::vector<Value>& b) {
  for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i)
    if (i >= a.size() || i >= b.size() || std::memcmp(&a[i], &b[i], sizeof(Value)) != 0)
      note(i < names_.size() ? names_[i] : "entry " + std::to_string(i), field, entry(a, i),
           entry(b, i));
}

void EstimateDiff::compare(const std::string& channel, const window_estimate_t& a,
                           const window_estimate_t& b) {
  channel_ = channel;
  end_us_ = a.window_end_us;
  same_ = true;
  const auto whole = [&](const char* field, auto of_a, auto of_b) {
    note("window", field, static_cast<double>(of_a), static_cast<double>(of_b));
  };
  whole("window_start_us", a.window_start_us, b.window_start_us);
  whole("sequence", a.sequence, b.sequence);
  whole("status", a.status, b.status);
  whole("rows", a.rows, b.rows);
  whole("residual_ratio", a.residual_ratio, b.residual_ratio);
  whole("parameters", a.parameters, b.parameters);
  whole("boxplot_windows", a.boxplot_windows, b.boxplot_windows);
  columns("value", a.value, b.value);
  columns("std_error", a.std_error, b.std_error);
  columns("reason", a.reason, b.reason);
  columns("snr", a.snr, b.snr);
  columns("prior_share", a.prior_share, b.prior_share);
  columns("noise_share", a.noise_share, b.noise_share);
  columns("held_value", held(a, a.held_value), held(b, b.held_value));
  columns("held_std_error", held(a, a.held_std_error), held(b, b.held_std_error));
  if (a.held_end_us != b.held_end_us || a.held_index != b.held_index)
    note("window", "held_end_us, held_index", static_cast<double>(a.held),
         static_cast<double>(b.held));
  for (const BoxColumn& box : kBoxColumns) columns(box.name, a.*box.values, b.*box.values);
  columns("outliers", a.outliers, b.outliers);
  columns("boxplot_count", a.boxplot_count, b.boxplot_count);
  ++compared_;
  different_ += !same_;
}

}  // namespace framewatch::daemon
