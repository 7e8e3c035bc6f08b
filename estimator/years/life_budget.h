// SPDX-License-Identifier: MIT
#pragma once

namespace framewatch::estimator {

/// False alarms that are accepted, with this probability one or more within so many years, and the
/// least loss that matters, relative.
struct LifeBudget {
  double years = 30, probability = 0.05;
  double least_loss = 0.01;
};

}  // namespace framewatch::estimator
