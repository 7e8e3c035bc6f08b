#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/propose/needed_signal.h"

namespace framewatch::estimator {

/// Weighted least squares of a needed force on complex columns with real coefficients. The last
/// column is the law's.
struct ScalarFit {
  double misfit = 1e300;
  Eigen::VectorXd coefficients;
};

/// Normal equations of one record. Those of several records add up.
struct ScalarSums {
  Eigen::MatrixXd normal;
  Eigen::VectorXd right;
  double total = 0;  ///< misfit without any column

  ScalarSums& operator+=(const ScalarSums& more);
  ScalarFit fit() const;
};

/// Computes the normal equations of one record. Removes from the force and the columns what the
/// ends of the segment can add.
ScalarSums scalar_sums(const NeededSignal& needed, const std::vector<Eigen::VectorXcd>& columns);

/// Fits the same coefficients to all records. columns: of each record.
ScalarFit scalar_fit(const std::vector<NeededSignal>& needed,
                     const std::vector<std::vector<Eigen::VectorXcd>>& columns);

/// Returns the needed force minus the part that a linear element explains; the whole force if the
/// place is not an element.
Eigen::VectorXcd beyond_linear(const RecordSegment& segment, const NeededSignal& needed);

}  // namespace framewatch::estimator
