#include "estimator/identify/noise/noise_moments.h"

namespace framewatch::estimator {
namespace {

/// Response of high-pass and one tap set to a unit impulse, long enough for the high-pass to decay.
std::vector<double> impulse_response(const std::vector<double>& taps, const HighPass& hp,
                                     std::size_t length) {
  std::vector<double> high(length), out(length, 0.0);
  double y1 = 0, y2 = 0;
  for (std::size_t t = 0; t < length; ++t) {
    const double change = t == 0 ? 1.0 : t == 1 ? -2.0 : t == 2 ? 1.0 : 0.0;
    const double y = hp.gain * change - hp.a1 * y1 - hp.a2 * y2;
    y2 = y1;
    y1 = y;
    high[t] = y;
  }
  for (std::size_t t = 0; t < length; ++t)
    for (std::size_t k = 0; k < taps.size() && k <= t; ++k) out[t] += taps[k] * high[t - k];
  return out;
}

}  // namespace

NoiseFilter::NoiseFilter(const DerivativeTriple& triple, const HighPass& high_pass,
                         std::size_t length) {
  for (const std::vector<double>* taps : {&triple.value, &triple.first, &triple.second})
    impulse_.push_back(impulse_response(*taps, high_pass, length));
}

NoiseMoments NoiseFilter::through(const OscillatorSection& section) const {
  NoiseMoments noise;
  double s[3][2] = {};
  for (std::size_t t = 0; t < impulse_[0].size(); ++t) {
    double y[3];
    for (std::size_t d = 0; d < 3; ++d) {
      y[d] = section.gain * impulse_[d][t] - section.a1 * s[d][0] - section.a2 * s[d][1];
      s[d][1] = s[d][0];
      s[d][0] = y[d];
    }
    noise.g00 += y[0] * y[0];
    noise.g11 += y[1] * y[1];
    noise.g22 += y[2] * y[2];
    noise.g20 += y[2] * y[0];
  }
  return noise;
}

}  // namespace framewatch::estimator
