// SPDX-License-Identifier: MIT
#include "estimator/watch/change_size.h"

#include <algorithm>
#include <cmath>

namespace framewatch::estimator {
namespace {

constexpr int kFewWindows = 4;  // the scatter of fewer windows cannot reduce the error

constexpr double kMemory = 60, kGroupMemory = 20;  // windows, groups of them
constexpr double kPrior = 5;                       // windows that scatter as their errors say
constexpr double kMaxSquare = 25;                  // largest squared error that counts

constexpr double kWithin = 3;  // standard errors of the element

/// Defaults for single elements: masses off by 2 % move other values by about this share of a
/// change.
constexpr double kOwn = 0.005, kLeak = 0.03;
/// Defaults for groups of up to six stories, as predict_layout() gives them for usual layouts.
constexpr double kOwnOfGroup = 0.3, kLeakOfGroup = 0.35;

}  // namespace

void ChangeSize::Mean::add(double ratio, double std_error, double common_error) {
  const double w = 1 / (std_error * std_error + common_error * common_error);
  ++count;
  weight += w;
  sum += w * ratio;
  square += w * ratio * ratio;
  common += w * common_error;
}

double ChangeSize::excess() const {
  if (mean_.count == 0) return 1;
  const double scatter = std::max(mean_.square - mean_.sum * mean_.sum / mean_.weight, 0.0);
  return std::max((kPriorWindows + scatter) / (kPriorWindows + mean_.count - 1),
                  mean_.count < kFewWindows ? 1.0 : kMinExcess);
}

double ChangeSize::std_error() const {
  return std::hypot(std::sqrt(excess() / mean_.weight), mean_.common / mean_.weight);
}

void ChangeSize::add(double ratio, double std_error, double common_error) {
  mean_.add(ratio, std_error, common_error);
  aside_ = {};
}

bool ChangeSize::push(double ratio, double error, double common_error) {
  const double off = known() ? ratio - this->ratio() : 0;
  if (std::abs(off) <= kFar * std::hypot(error, common_error, known() ? std_error() : 0)) {
    add(ratio, error, common_error);
    return false;
  }
  const double before = aside_.weight > 0 ? aside_.sum / aside_.weight - this->ratio() : 0;
  if (before * off < 0) aside_ = {};
  const bool again = aside_.weight > 0;
  aside_.add(ratio, error, common_error);
  if (!again) return false;
  mean_ = aside_;
  aside_ = {};
  return true;
}

ChangeModel usual_change_model(const ParameterTable& table) {
  const auto n = static_cast<std::size_t>(table.elements());
  const bool grouped = table.grouped();
  return {std::vector<double>(n, grouped ? kOwnOfGroup : kOwn),
          std::vector<double>(n * n, grouped ? kLeakOfGroup : kLeak)};
}

void UsualScatter::push(Time start, Time end, double off, double error) {
  if (windows_ > 0 && start < until_) return;
  until_ = end;
  if (windows_ > 0) {
    const double step = off - last_off_;
    const double square =
        std::min(step * step / (error * error + last_error_ * last_error_), kMaxSquare);
    excess_ += (square - excess_) / std::min(kPrior + static_cast<double>(windows_), kMemory);
  }
  ++windows_;
  last_off_ = off;
  last_error_ = error;
  weight_ += 1 / (error * error);
  sum_ += off / (error * error);
  if (++group_ < kGroup) return;
  ++groups_;
  const double mean = sum_ / weight_, by_chance = excess() / weight_;
  slow_ += (mean * mean - by_chance - slow_) / std::min(static_cast<double>(groups_), kGroupMemory);
  chance_ += (by_chance - chance_) / std::min(static_cast<double>(groups_), kGroupMemory);
  group_ = 0;
  weight_ = sum_ = 0;
}

double UsualScatter::slow() const {
  if (groups_ == 0) return 0;
  const double error =
      chance_ * std::sqrt(2 / std::min(static_cast<double>(groups_), kGroupMemory));
  return std::sqrt(std::max(slow_ - error, 0.0));
}

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

bool are_alike(const std::vector<Deviation>& deviations, double price) {
  if (deviations.size() < 2) return false;
  double weight = 0, sum = 0;
  for (const auto& [off, error] : deviations) {
    weight += 1 / (error * error);
    sum += off / (error * error);
  }
  const double common = sum / weight;
  double alike = price, apart = 0;
  for (const auto& [off, error] : deviations) {
    alike += std::min(std::pow((off - common) / error, 2), price);
    apart += std::min(std::pow(off / error, 2), price);
  }
  return alike < apart;
}

}  // namespace framewatch::estimator
