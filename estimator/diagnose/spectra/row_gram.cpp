// SPDX-License-Identifier: MIT
#include "estimator/diagnose/spectra/row_gram.h"

#include "estimator/numeric/kernels.h"

namespace framewatch::estimator {

using Eigen::Index;

void multiply(const RowMatrix& a, const RowMatrix& b, RowMatrix& out) {
  out.setZero(a.rows(), b.cols());
  kernels::in_use->multiply_add(a.data(), static_cast<int>(a.cols()), static_cast<int>(a.rows()),
                                static_cast<int>(b.rows()), b.data(), out.data(),
                                static_cast<int>(b.cols()));
}

RowGram::RowGram(Index columns) : columns_(columns) {
  const int front = static_cast<int>(columns);
  std::size_t size = 0;
  for (int i = 0; i < front; ++i)
    size += static_cast<std::size_t>(padded(front) - packed_row_begin(i));
  packed_.assign(size, 0.0);
}

Eigen::Block<RowMatrix> RowGram::rows(Index count, Index first) {
  const Index length = padded(static_cast<int>(columns_)) - first;
  if (rows_.rows() != count || rows_.cols() != length) rows_ = RowMatrix::Zero(count, length);
  first_ = first;
  return rows_.leftCols(columns_ - first);
}

void RowGram::add() {
  double* from = packed_.data();
  for (Index i = 0; i < first_; ++i)
    from += first_ + rows_.cols() - packed_row_begin(static_cast<int>(i));
  kernels::in_use->add_rows(from, from, rows_.data(), static_cast<int>(rows_.rows()),
                            static_cast<int>(columns_ - first_), static_cast<int>(rows_.cols()));
}

Eigen::MatrixXd RowGram::sum() const {
  Eigen::MatrixXd out(columns_, columns_);
  const int front = static_cast<int>(columns_), stride = padded(front);
  const double* row = packed_.data();
  for (int i = 0; i < front; ++i) {
    const int first = packed_row_begin(i);
    for (int j = i; j < front; ++j) out(i, j) = out(j, i) = row[j - first];
    row += stride - first;
  }
  return out;
}

}  // namespace framewatch::estimator
