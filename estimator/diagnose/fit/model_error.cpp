#include "estimator/diagnose/fit/model_error.h"

#include <algorithm>
#include <cmath>
#include <complex>

namespace framewatch::estimator {

using Eigen::Index;

bool is_output(const Plant& plant, Index axis) {
  return plant.prescribed ? plant.is_force(axis) : !plant.is_input(axis);
}

std::vector<RecordSegment> with_model_error(const Plant& plant,
                                            const std::vector<RecordSegment>& segments,
                                            double share) {
  std::vector<RecordSegment> out = segments;
  for (RecordSegment& s : out) {
    double power = 0;
    Index outputs = 0;
    for (Index a = 0; a < plant.axis_count(); ++a) {
      if (!is_output(plant, a)) continue;
      ++outputs;
      for (Index b = 0; b < s.bins(); ++b)
        power += std::norm(s.spectrum(a, b)) / (s.is_displaced(a) ? std::pow(s.w[b], 4) : 1.0);
    }
    const auto numbers = static_cast<double>(std::max<Index>(1, outputs * s.bins()));
    const double variance =
        share * share * power / (numbers * static_cast<double>(std::max<Index>(1, s.intervals())));
    const double noise = s.variance.sum();
    for (Index a = 0; a < plant.axis_count(); ++a)
      if (is_output(plant, a)) s.variance[a] += variance;
    s.corner_hz *= noise / std::max(s.variance.sum(), 1e-300);  // the model's error is white
  }
  return out;
}

}  // namespace framewatch::estimator
