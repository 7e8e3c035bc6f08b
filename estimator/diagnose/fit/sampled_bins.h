#pragma once

#include <vector>

#include "estimator/diagnose/fit/linearised.h"

namespace framewatch::estimator {

/// A bin that stands for `weight` bins in the curvature of a fit.
struct SampledBin {
  Eigen::Index bin = 0;
  double weight = 1;
};

/// The bins whose products make up the curvature of a fit to a large building: about an eighth of
/// all, those with much motion for certain, the others by their share of it (systematic sampling
/// with unequal chances, each weighted with the inverse of its own), and those with much of an
/// effect's column. The curvature only directs steps; gradients and misfits are those of all bins.
std::vector<SampledBin> sampled_bins(const Linearised& at, std::size_t record);

}  // namespace framewatch::estimator
