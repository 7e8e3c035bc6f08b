#pragma once

#include <vector>

#include <Eigen/Core>

namespace framewatch {

/// Rows of numbers, row after row in memory.
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// out = a b with the instruction set that the machine has (identify/kernels.h). a: its columns
/// beyond the rows of b are not looked at; b: a multiple of kLane columns.
void multiply(const RowMatrix& a, const RowMatrix& b, RowMatrix& out);

/// Sum of the outer products of rows, the same way.
class Gram {
 public:
  explicit Gram(Eigen::Index columns);

  /// Where the next rows are written before add(): rows x columns. Not kept from one to the next.
  Eigen::Block<RowMatrix> rows(Eigen::Index count);
  /// Adds what was written there.
  void add();
  /// What was written, padded with zeros to whole lanes.
  const RowMatrix& written() const { return rows_; }
  /// columns x columns, symmetric.
  Eigen::MatrixXd sum() const;

 private:
  Eigen::Index columns_;
  RowMatrix rows_;
  std::vector<double> packed_;
};

}  // namespace framewatch
