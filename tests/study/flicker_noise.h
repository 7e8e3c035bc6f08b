// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>

#include "estimator/simulate/random.h"

namespace framewatch::study {

/// Noise of unit power whose density falls as 1/f over three decades, from a quarter of the rate
/// down: a sum of low-pass noises whose corners differ by factors of four.
class FlickerNoise {
 public:
  explicit FlickerNoise(estimator::Random& random) : random_(random) {
    for (double& part : parts_) part = random_.normal();
  }

  double next() {
    double sum = 0, rate = 0.25 * 2 * M_PI;
    for (double& part : parts_) {
      const double keep = std::exp(-rate);
      part = keep * part + std::sqrt(1 - keep * keep) * random_.normal();
      sum += part;
      rate /= 4;
    }
    return sum / std::sqrt(static_cast<double>(parts_.size()));
  }

 private:
  estimator::Random& random_;
  std::array<double, 5> parts_{};
};

}  // namespace framewatch::study
