#include "estimator/watch/change_size.h"

#include <cmath>

namespace framewatch::estimator {

void ChangeSize::Mean::add(double ratio, double std_error, double common_error) {
  const double w = 1 / (std_error * std_error + common_error * common_error);
  weight += w;
  sum += w * ratio;
  common += w * common_error;
}

double ChangeSize::std_error() const {
  return std::hypot(1 / std::sqrt(mean_.weight), mean_.common / mean_.weight);
}

void ChangeSize::push(double ratio, double error, double common_error) {
  const double off = known() ? ratio - this->ratio() : 0;
  if (std::abs(off) <= kFar * std::hypot(error, common_error, known() ? std_error() : 0)) {
    mean_.add(ratio, error, common_error);
    aside_ = {};
    return;
  }
  const double before = aside_.weight > 0 ? aside_.sum / aside_.weight - this->ratio() : 0;
  if (before * off < 0) aside_ = {};
  const bool again = aside_.weight > 0;
  aside_.add(ratio, error, common_error);
  if (!again) return;
  mean_ = aside_;
  aside_ = {};
}

}  // namespace framewatch::estimator
