#include "estimator/watch/common_change.h"

#include <algorithm>
#include <cmath>

namespace framewatch::estimator {
namespace {

constexpr double kWithin = 3;  // standard errors of the element

}  // namespace

CommonChange::CommonChange(std::size_t most) : most_(most) {
  elements_.reserve(most);
}

void CommonChange::add(double off, double std_error) {
  if (elements_.size() == most_) return;
  elements_.push_back({off, std_error, 1 / (std_error * std_error)});
}

CommonChange::Mean CommonChange::mean(std::size_t least) {
  if (elements_.empty() || elements_.size() < least) return {};
  std::sort(elements_.begin(), elements_.end(),
            [](const Element& a, const Element& b) { return a.off < b.off; });
  double total = 0, below = 0;
  for (const Element& e : elements_) total += e.weight;
  std::size_t middle = 0;
  while (middle + 1 < elements_.size() && below + elements_[middle].weight < total / 2)
    below += elements_[middle++].weight;
  const double median = elements_[middle].off;
  double weight = 0, sum = 0;
  std::size_t agree = 0;
  for (const Element& e : elements_) {
    if (std::abs(e.off - median) > kWithin * e.std_error) continue;
    ++agree;
    weight += e.weight;
    sum += e.weight * e.off;
  }
  if (static_cast<double>(agree) < kAgree * static_cast<double>(elements_.size())) return {};
  return {sum / weight, 1 / std::sqrt(weight), true};
}

}  // namespace framewatch::estimator
