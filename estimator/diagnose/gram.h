#pragma once

#include <vector>

#include <Eigen/Core>

namespace framewatch {

/// Rows of numbers, row after row in memory.
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Sum of the outer products of rows, with the instruction set that the machine has
/// (identify/kernels.h).
class Gram {
 public:
  explicit Gram(Eigen::Index columns);

  /// Where the next rows are written before add(): rows x columns. Not kept from one to the next.
  Eigen::Block<RowMatrix> rows(Eigen::Index count);
  /// Adds what was written there.
  void add();
  /// Adds the outer products of coefficients times the rows written into another.
  void add_combined(const RowMatrix& coefficients, const Gram& other);
  /// columns x columns, symmetric.
  Eigen::MatrixXd sum() const;

 private:
  Eigen::Index columns_;
  RowMatrix rows_;  ///< padded with zeros
  std::vector<double> packed_;
};

}  // namespace framewatch
