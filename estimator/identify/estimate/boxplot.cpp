// SPDX-License-Identifier: MIT
#include "estimator/identify/estimate/boxplot.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimator/numeric/kernels.h"
#include "estimator/numeric/nan.h"

namespace framewatch::estimator {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();
constexpr double kMaxValue = 1e100;  // magnitude

std::size_t round_up(std::size_t value, std::size_t step) {
  return (value + step - 1) / step * step;
}

}  // namespace

BoxplotWindow::BoxplotWindow(int windows)
    : ring_(static_cast<std::size_t>(windows), kNone),
      sorted_(round_up(ring_.size(), kernels::kGuideStep), kNone),
      guide_(round_up(sorted_.size() / kernels::kGuideStep, kernels::kGuidePadding), kNone) {}

void BoxplotWindow::reset() {
  for (std::vector<double>* values : {&ring_, &sorted_, &guide_})
    std::fill(values->begin(), values->end(), kNone);
  next_ = count_ = 0;
}

void BoxplotWindow::push(double value) {
  if (ring_.empty()) return;
  const double leaving = ring_[next_];
  const double entering = std::isfinite(value) ? value : kNone;
  ring_[next_] = entering;
  next_ = next_ + 1 == ring_.size() ? 0 : next_ + 1;
  if (entering != kNone) ++count_;
  if (leaving != kNone) --count_;
  kernels::in_use->replace_sorted(sorted_.data(), static_cast<int>(sorted_.size()), guide_.data(),
                                  static_cast<int>(guide_.size()), leaving, entering);
}

/// With n values, probability q / 4 lies between two sorted values. Its place, in eighths from the
/// lower one, follows from q n / 4 - 1 / 2.
double BoxplotWindow::quartile(std::size_t q) const {
  const std::size_t eighths = 2 * q * count_;
  const std::size_t last = 8 * (count_ - 1);
  const std::size_t place = eighths < 4 ? 0 : std::min(eighths - 4, last);
  const double* below = &sorted_[place / 8];
  const double part = static_cast<double>(place % 8) / 8;
  return part > 0 ? below[0] + part * (below[1] - below[0]) : below[0];
}

bool BoxplotWindow::consistent() const {
  if (next_ > 0 && next_ >= ring_.size()) return false;
  std::vector<double> sorted = ring_;
  if (std::any_of(sorted.begin(), sorted.end(), [](double v) { return !(v >= -kMaxValue); }))
    return false;
  std::sort(sorted.begin(), sorted.end());
  sorted.resize(sorted_.size(), kNone);
  return sorted == sorted_ &&
         static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), kNone) -
                                  sorted.begin()) == count_;
}

BoxplotStatistics BoxplotWindow::statistics() const {
  if (count_ == 0) return {kNaN, kNaN, kNaN, kNaN, kNaN, 0, 0};
  BoxplotStatistics out{quartile(1), quartile(2), quartile(3), 0, 0, 0, 0};
  const double reach = 1.5 * (out.q3 - out.q1);
  const double* low = sorted_.data();
  const double* high = low + count_;
  if (*low < out.q1 - reach) low = std::lower_bound(low, high, out.q1 - reach);
  if (*(high - 1) > out.q3 + reach) high = std::upper_bound(low, high, out.q3 + reach);
  out.whisker_low = *low;
  out.whisker_high = *(high - 1);
  out.count = static_cast<int>(count_);
  out.outliers = out.count - static_cast<int>(high - low);
  return out;
}

}  // namespace framewatch::estimator
