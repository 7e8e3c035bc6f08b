// SPDX-License-Identifier: MIT
#include "estimator/diagnose/law/law_parameter.h"

#include <algorithm>
#include <cmath>

namespace framewatch::estimator {

double LawParameter::plain() const {
  return logarithmic ? std::exp(value) : value;
}

bool at_bound(const LawParameter& parameter) {
  constexpr double kNear = 1e-6;
  return parameter.value <= parameter.low + kNear || parameter.value >= parameter.high - kNear;
}

LawParameter linear_parameter(double value, double step) {
  LawParameter out;
  out.value = value;
  out.step = std::max(std::abs(step), 1e-30);
  return out;
}

LawParameter logarithmic_parameter(double value, double low, double high) {
  LawParameter out;
  out.logarithmic = true;
  out.value = std::log(value);
  out.step = 0.02;
  out.low = std::log(low);
  out.high = std::log(high);
  return out;
}

LawParameter bounded_parameter(double value, double step, double low, double high, bool free) {
  LawParameter out = linear_parameter(value, step);
  out.low = low;
  out.high = high;
  out.free = free;
  return out;
}

LawParameter fixed_parameter(double value) {
  return bounded_parameter(value, 1, -1e300, 1e300, false);
}

}  // namespace framewatch::estimator
