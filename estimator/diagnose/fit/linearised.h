#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/fit/fit_columns.h"
#include "estimator/diagnose/fit/unknowns.h"
#include "estimator/diagnose/fit/whitened.h"

namespace framewatch::estimator {

/// The whitened equations of all segments, linearised around one model.
struct Linearised {
  const Plant* plant = nullptr;
  std::vector<Unknown> unknowns;
  std::vector<Whitened> systems;  ///< of each segment
  std::vector<Columns> columns;   ///< of each segment: d(rows)/d(unknowns)
  /// Ratio of misfit to its expectation under noise, at least 1. The prior is weighted by it, so
  /// that a model that does not fit cannot compensate with masses, gains and clocks.
  double level = 1;
  Eigen::VectorXd prior, pull;  ///< level / (2 sigma^2); that times (centre - value)
};

}  // namespace framewatch::estimator
