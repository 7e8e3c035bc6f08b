#pragma once

#include <vector>

#include "estimator/diagnose/fit/linearised.h"

namespace framewatch::estimator {

/// A bin that stands for `weight` bins in the curvature of a fit.
struct SampledBin {
  Eigen::Index bin = 0;
  double weight = 1;
};

/// Returns the bins whose products make up the curvature of a fit to a large building: about an
/// eighth of all. Bins with much motion are always included; others are sampled with a chance
/// proportional to their share of it (systematic sampling, weighted by the inverse chance). Bins
/// with much of an effect's column are included too. The curvature only directs steps; gradients
/// and misfits use all bins.
std::vector<SampledBin> sampled_bins(const Linearised& at, std::size_t record);

}  // namespace framewatch::estimator
