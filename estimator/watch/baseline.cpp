#include "estimator/watch/baseline.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace framewatch {

Baseline::Baseline(std::size_t parameters)
    : value(parameters, std::numeric_limits<double>::quiet_NaN()),
      std_error(parameters, std::numeric_limits<double>::quiet_NaN()) {}

BaselineLearner::BaselineLearner(int parameters, double learn_s)
    : learn_s_(learn_s), sums_(static_cast<std::size_t>(parameters)) {}

bool BaselineLearner::push(const WindowEstimate& e) {
  if (complete() || e.window != 0 || e.status != WindowStatus::valid) return false;
  if (windows_ > 0 && e.start <= end_) return false;
  end_ = e.end;
  ++windows_;
  learned_s_ += std::chrono::duration<double>(e.end - e.start).count();
  for (std::size_t p = 0; p < sums_.size(); ++p) {
    if (e.reason[p] != Observability::observable) continue;
    Sum& sum = sums_[p];
    if (sum.count++ == 0) sum.first = e.value[p];
    const double weight = 1 / (e.std_error[p] * e.std_error[p]);
    const double off = e.value[p] - sum.first;
    sum.weight += weight;
    sum.value += weight * off;
    sum.square += weight * off * off;
  }
  return complete();
}

Baseline BaselineLearner::baseline() const {
  Baseline out(sums_.size());
  for (std::size_t p = 0; p < sums_.size(); ++p) {
    const Sum& sum = sums_[p];
    if (sum.count == 0 || 2 * sum.count < windows_) continue;
    const double mean = sum.value / sum.weight;
    const double scatter = std::max(sum.square - sum.weight * mean * mean, 0.0);
    const double excess = sum.count > 1 ? scatter / (sum.count - 1) : 1.0;
    out.value[p] = sum.first + mean;
    out.std_error[p] = std::sqrt(std::max(excess, 1.0) / sum.weight);
  }
  return out;
}

}  // namespace framewatch
