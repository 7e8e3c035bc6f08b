#include "estimator/shaking/fragility.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace framewatch::estimator {

std::array<double, kDamageStates> damage_probabilities(const Fragility& fragility,
                                                       double drift_ratio, double std_error) {
  std::array<double, kDamageStates> out{};
  const double relative = std_error / drift_ratio;
  const double variance = std::log1p(relative * relative);  // of the drift's logarithm
  for (std::size_t i = 0; i < kDamageStates; ++i) {
    const double spread = std::sqrt(fragility.dispersion[i] * fragility.dispersion[i] + variance);
    const double z = std::log(drift_ratio / fragility.median[i]) / spread;
    out[i] = 0.5 * std::erfc(-z / std::numbers::sqrt2);
    if (i > 0) out[i] = std::min(out[i], out[i - 1]);
  }
  return out;
}

}  // namespace framewatch::estimator
