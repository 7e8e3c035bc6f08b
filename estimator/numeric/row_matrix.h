#pragma once

#include <Eigen/Core>

namespace framewatch::estimator {

/// Rows of numbers, row after row in memory.
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace framewatch::estimator
