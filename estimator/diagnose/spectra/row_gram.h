#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/numeric/solve.h"

namespace framewatch::estimator {

/// out = a b with the instruction set that the machine has (estimator/numeric/kernels.h). a: its
/// columns beyond the rows of b are ignored; b: a multiple of kLane columns.
void multiply(const RowMatrix& a, const RowMatrix& b, RowMatrix& out);

/// Sum of the outer products of rows, with the same kernels.
class RowGram {
 public:
  explicit RowGram(Eigen::Index columns);

  /// Where the caller writes the next rows before add(), from column `first` on: count x columns
  /// from there. They are zero before it; first: a multiple of kLane. Contents do not persist.
  Eigen::Block<RowMatrix> rows(Eigen::Index count, Eigen::Index first = 0);
  /// Adds these rows to the sum.
  void add();
  /// These rows, padded with zeros to whole lanes.
  const RowMatrix& written() const { return rows_; }
  /// columns x columns, symmetric.
  Eigen::MatrixXd sum() const;

 private:
  Eigen::Index columns_, first_ = 0;
  RowMatrix rows_;
  std::vector<double> packed_;
};

}  // namespace framewatch::estimator
