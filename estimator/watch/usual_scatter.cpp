#include "estimator/watch/usual_scatter.h"

#include <algorithm>
#include <cmath>

namespace framewatch::estimator {
namespace {

constexpr double kGroupPrior = 3;                  // groups without slow changes
constexpr double kMemory = 60, kGroupMemory = 20;  // windows, groups of them
constexpr double kPrior = 5;                       // windows that scatter as their errors say
constexpr double kMaxSquare = 25;                  // squared errors that a wild one counts as

}  // namespace

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

}  // namespace framewatch::estimator
