#include "estimator/identify/boxplot.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace framewatch {

namespace {

/// std::lower_bound (before = less) and std::upper_bound (before = not greater) without branches:
/// where a new value lies among the old ones nobody can predict.
template <typename Before>
const double* bound(const std::vector<double>& sorted, Before before) {
  const double* from = sorted.data();
  for (std::size_t left = sorted.size(); left > 0;) {
    const std::size_t half = (left + 1) / 2;
    from = before(from[half - 1]) ? from + half : from;
    left -= half;
  }
  return from;
}

}  // namespace

BoxplotWindow::BoxplotWindow(int windows)
    : ring_(static_cast<std::size_t>(windows), std::numeric_limits<double>::quiet_NaN()) {
  sorted_.reserve(ring_.size());
}

void BoxplotWindow::reset() {
  std::fill(ring_.begin(), ring_.end(), std::numeric_limits<double>::quiet_NaN());
  sorted_.clear();
  next_ = 0;
}

void BoxplotWindow::push(double value) {
  if (ring_.empty()) return;
  const double leaving = ring_[next_];
  ring_[next_] = value;
  next_ = (next_ + 1) % ring_.size();
  const bool leaves = !std::isnan(leaving);
  const auto place = [&](const double* at) { return sorted_.begin() + (at - sorted_.data()); };
  const auto from = place(bound(sorted_, [&](double v) { return v < leaving; }));
  if (std::isnan(value)) {
    if (leaves) sorted_.erase(from);
    return;
  }
  const auto to = place(bound(sorted_, [&](double v) { return v <= value; }));
  if (!leaves) {
    sorted_.insert(to, value);
    return;
  }
  // One value out, one in: only what lies between them moves.
  if (from < to) {
    std::move(from + 1, to, from);
    *(to - 1) = value;
  } else {
    std::move_backward(to, from, from + 1);
    *to = value;
  }
}

double BoxplotWindow::quantile(double probability) const {
  const auto n = static_cast<double>(sorted_.size());
  const double place = std::clamp(probability * n - 0.5, 0.0, n - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted_.size() - 1);
  const double part = place - static_cast<double>(below);
  return sorted_[below] + part * (sorted_[above] - sorted_[below]);
}

BoxplotStatistics BoxplotWindow::statistics() const {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (sorted_.empty()) return {kNone, kNone, kNone, kNone, kNone, 0, 0};
  BoxplotStatistics out{quantile(0.25), quantile(0.5), quantile(0.75), 0, 0, 0, 0};
  const double reach = 1.5 * (out.q3 - out.q1);
  auto low = sorted_.begin(), high = sorted_.end();
  if (*low < out.q1 - reach) low = std::lower_bound(low, high, out.q1 - reach);
  if (*(high - 1) > out.q3 + reach) high = std::upper_bound(low, high, out.q3 + reach);
  out.whisker_low = *low;
  out.whisker_high = *(high - 1);
  out.count = static_cast<int>(sorted_.size());
  out.outliers = out.count - static_cast<int>(high - low);
  return out;
}

}  // namespace framewatch
