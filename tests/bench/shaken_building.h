// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/pipeline/pipeline.h"
#include "tests/bench/alternatives.h"

namespace framewatch::bench {

/// A building of `stories` stories, bays x bays in plan, slightly uneven so that it twists, with a
/// sensor on every degree of freedom.
estimator::PipelineConfig building(int stories, int bays);

/// Absolute accelerations, instants x axes at 100 Hz, of a building that differs from the design by
/// up to 10 %, shaken obliquely, with sensor noise. Newmark's method on sparse matrices: quick for
/// any number of stories, and exactness does not matter here.
Eigen::MatrixXd shaken(const estimator::PipelineConfig& config, int instants);

/// Random windows of element motion of the same size, as input for the alternatives.
struct DenseInput {
  DenseInput(const estimator::PipelineConfig& config, int instants);
  Pattern pattern() const;
  int stride() const { return 2 * elements + equations; }

  int equations, elements;
  std::vector<int> equation, element;
  std::vector<double> coefficient;
  std::vector<double> motion;  ///< instants x stride()
};

}  // namespace framewatch::bench
