// SPDX-License-Identifier: MIT
// Quantiles that are one of the values, and the three ways to take a median of an even number of
// values. Values must not be NaN; infinite values count.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "estimator/numeric/nan.h"

namespace framewatch::estimator {

/// Returns the value at place `rank` of the sorted values; 0 is the smallest. Reorders `values`.
template <typename T>
T ranked(std::vector<T>& values, std::size_t rank) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Returns the median: the upper one of two middle values. Returns `otherwise` without values.
/// Reorders `values`.
inline double upper_median(std::vector<double>& values, double otherwise = kNaN) {
  return values.empty() ? otherwise : ranked(values, values.size() / 2);
}

/// Returns the median: the lower one of two middle values. Reorders `values`, of which there must
/// be one at least.
template <typename T>
T lower_median(std::vector<T>& values) {
  return ranked(values, (values.size() - 1) / 2);
}

/// Returns the median: the mean of two middle values. Returns NaN without values. Keeps its input.
inline double mean_median(std::vector<double> values) {
  const double upper = upper_median(values);
  if (values.empty() || values.size() % 2 == 1) return upper;
  return 0.5 * (upper + *std::max_element(values.begin(), values.begin() + std::ssize(values) / 2));
}

/// Returns the quantile of `share`, 0..1: the value whose rank is nearest to share times the
/// highest rank. Returns NaN without values. Keeps its input.
inline double quantile(std::vector<double> values, double share) {
  if (values.empty()) return kNaN;
  const double rank = share * static_cast<double>(values.size() - 1);
  return ranked(values, static_cast<std::size_t>(std::llround(rank)));
}

}  // namespace framewatch::estimator
