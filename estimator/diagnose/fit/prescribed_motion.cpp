#include "estimator/diagnose/fit/prescribed_motion.h"

#include <complex>

#include "estimator/diagnose/spectra/fourier.h"

namespace framewatch::estimator {

using Eigen::Index;
using Eigen::VectorXcd;
using Eigen::VectorXd;

std::optional<PrescribedMotion> prescribed_motion(const Plant& plant, const RecordSegment& segment,
                                                  const Eigen::RowVectorXd& sense, int ratio) {
  if (!plant.prescribed) return std::nullopt;
  for (Index a = 0; a < sense.size(); ++a)
    if (sense[a] != 0 && !segment.is_displaced(a) && !plant.is_input(a)) return std::nullopt;
  const Index samples = segment.intervals();
  VectorXd d = VectorXd::Zero(samples + 1);
  for (Index a = 0; a < sense.size(); ++a)
    if (segment.is_displaced(a)) d += sense[a] * segment.accel.col(a);

  // A line between the ends is taken off, and added again: the rest is periodic.
  const double slope = (d[samples] - d[0]) / static_cast<double>(samples), first = d[0];
  const VectorXd line =
      VectorXd::LinSpaced(samples, first, first + slope * static_cast<double>(samples - 1));
  const Index bins = segment.first_bin + segment.bins();
  const VectorXcd half = forward_fourier(VectorXd(d.head(samples) - line)).head(bins);
  VectorXcd rate = half;
  for (Index b = 0; b < bins; ++b)
    rate[b] *= std::complex<double>(
        0, 2 * M_PI * static_cast<double>(b) * segment.rate_hz / static_cast<double>(samples));
  PrescribedMotion out;
  out.d = ratio * inverse_fourier(half, samples * ratio);
  out.v = ratio * inverse_fourier(rate, samples * ratio);
  for (Index i = 0; i < out.d.size(); ++i)
    out.d[i] += first + slope * static_cast<double>(i) / ratio;
  out.v.array() += slope * segment.rate_hz;
  return out;
}

}  // namespace framewatch::estimator
