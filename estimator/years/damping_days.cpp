// SPDX-License-Identifier: MIT
#include "estimator/years/damping_days.h"

#include <cmath>

#include "estimator/numeric/nan.h"

namespace framewatch::estimator {

DayValue as_stiffness(const DayValue& damping) {
  if (!(damping.value > 0)) return {kNaN, kNaN};
  const double value = std::pow(damping.value, -1 / kDampingPower);
  return {value, value * damping.std_error / damping.value / kDampingPower};
}

YearsWatch::Finding as_damping(YearsWatch::Finding finding) {
  const double grown = std::pow(1 + finding.ratio, -kDampingPower);
  finding.std_error *= kDampingPower * grown / (1 + finding.ratio);
  finding.ratio = grown - 1;
  return finding;
}

}  // namespace framewatch::estimator
