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

Eigen::Block<RowMatrix> RowGram::rows(Index count) {
  if (rows_.rows() != count) rows_ = RowMatrix::Zero(count, padded(static_cast<int>(columns_)));
  return rows_.leftCols(columns_);
}

void RowGram::add() {
  kernels::in_use->add_rows(packed_.data(), packed_.data(), rows_.data(),
                            static_cast<int>(rows_.rows()), static_cast<int>(columns_),
                            static_cast<int>(rows_.cols()));
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
