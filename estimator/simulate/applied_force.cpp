#include "estimator/simulate/applied_force.h"

#include <cmath>
#include <cstdint>

#include "estimator/simulate/random.h"

namespace framewatch::estimator {
namespace {

constexpr int kTones = 100;  ///< one in each of as many equal parts of the band

}  // namespace

AppliedForce::AppliedForce(const Effect& e) : from_s_(e.value("from_s")) {
  if (e.value("amplitude_n") > 0)
    tones_.push_back(
        {e.value("amplitude_n"), 2 * M_PI * e.value("frequency_hz"), e.value("phase_rad")});
  if (e.value("rms_n") <= 0) return;
  Random random(static_cast<std::uint64_t>(e.value("seed")), 0);
  const double low_hz = e.value("low_hz");
  const double part_hz = (e.value("high_hz") - low_hz) / kTones;
  for (int i = 0; i < kTones; ++i) {
    const double frequency_hz = low_hz + part_hz * (i + random.uniform());
    const double phase = 2 * M_PI * random.uniform();
    tones_.push_back({e.value("rms_n") * std::sqrt(2.0 / kTones), 2 * M_PI * frequency_hz, phase});
  }
}

double AppliedForce::at(double time_s) const {
  double sum = 0;
  for (const Tone& tone : tones_)
    sum += tone.amplitude * std::sin(tone.omega * time_s + tone.phase);
  return sum;
}

}  // namespace framewatch::estimator
