#include "estimator/diagnose/spectra/upsampled.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace framewatch::estimator {

using Eigen::Index;
using Eigen::VectorXd;

constexpr int kSincHalf = 12;  ///< taps on either side

VectorXd upsampled(const VectorXd& signal, int ratio, double shift) {
  if (ratio == 1 && shift == 0) return signal;
  const Index size = signal.size();
  VectorXd out = VectorXd::Zero(size * ratio);
  for (int phase = 0; phase < ratio; ++phase) {
    const double at = static_cast<double>(phase) / ratio - shift;
    const auto whole = static_cast<Index>(std::floor(at));
    std::vector<double> taps;
    double sum = 0;
    for (int k = -kSincHalf + 1; k <= kSincHalf; ++k) {
      const double x = k - (at - static_cast<double>(whole));
      const double sinc = std::abs(x) < 1e-12 ? 1.0 : std::sin(M_PI * x) / (M_PI * x);
      const double taper_at = x / (kSincHalf + 0.5);
      const double taper =
          0.42 + 0.5 * std::cos(M_PI * taper_at) + 0.08 * std::cos(2 * M_PI * taper_at);
      taps.push_back(sinc * taper);
      sum += taps.back();
    }
    for (double& tap : taps) tap /= sum;
    for (Index i = 0; i < size; ++i) {
      double value = 0;
      for (int k = -kSincHalf + 1; k <= kSincHalf; ++k) {
        const Index from = std::clamp<Index>(i + whole + k, 0, size - 1);
        value += taps[static_cast<std::size_t>(k + kSincHalf - 1)] * signal[from];
      }
      out[i * ratio + phase] = value;
    }
  }
  return out;
}

}  // namespace framewatch::estimator
