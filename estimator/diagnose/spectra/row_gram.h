// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/numeric/solve.h"

namespace framewatch::estimator {

/// Sets out = a b with the machine's instruction set (estimator/numeric/kernels.h). Ignores columns
/// of a beyond the rows of b. b: a multiple of kLane columns.
void multiply(const RowMatrix& a, const RowMatrix& b, RowMatrix& out);

/// Sum of the outer products of rows, with the same kernels.
class RowGram {
 public:
  explicit RowGram(Eigen::Index columns);

  /// Returns where the caller writes the next rows before add(): `count` rows, from column `first`
  /// on. The columns before `first` count as zero; first: a multiple of kLane. Contents do not
  /// persist.
  Eigen::Block<RowMatrix> rows(Eigen::Index count, Eigen::Index first = 0);
  /// Adds these rows to the sum.
  void add();
  /// Returns these rows, padded with zeros to whole lanes.
  const RowMatrix& written() const { return rows_; }
  /// Returns the sum: columns x columns, symmetric.
  Eigen::MatrixXd sum() const;

 private:
  Eigen::Index columns_, first_ = 0;
  RowMatrix rows_;
  std::vector<double> packed_;
};

}  // namespace framewatch::estimator
