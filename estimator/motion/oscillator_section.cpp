#include "estimator/motion/oscillator_section.h"

#include <cmath>

namespace framewatch::estimator {

OscillatorSection::OscillatorSection(double corner_hz, double damping, double rate_hz) {
  const double w = std::tan(M_PI * corner_hz / rate_hz);
  const double norm = 1 / (1 + 2 * damping * w + w * w);
  a1 = 2 * (w * w - 1) * norm;
  a2 = (1 - 2 * damping * w + w * w) * norm;
  gain = 4 * w * w * norm;
}

}  // namespace framewatch::estimator
