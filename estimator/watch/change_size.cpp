#include "estimator/watch/change_size.h"

#include <algorithm>
#include <cmath>

namespace framewatch::estimator {
namespace {

constexpr int kFewWindows = 4;  // whose scatter is not believed to be smaller

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

}  // namespace framewatch::estimator
