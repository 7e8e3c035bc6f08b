// SPDX-License-Identifier: MIT
#include "estimator/diagnose/spectra/row_gram.h"

#include <limits>

#include <gtest/gtest.h>

#include "estimator/numeric/kernels.h"
#include "estimator/simulate/random.h"

namespace framewatch::estimator {
namespace row_gram_test {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr double kRounding = 1e-12;

RowMatrix random_rows(Index rows, Index columns, std::uint64_t seed) {
  Random random(seed);
  RowMatrix out(rows, columns);
  for (Index i = 0; i < out.size(); ++i) out.data()[i] = random.normal();
  return out;
}

TEST(RowProduct, EqualsTheProductOfMatrices) {
  struct Case {
    Index rows, inner, columns;
  };
  for (const Case& c : {Case{1, 1, 4}, Case{3, 2, 8}, Case{8, 8, 12}, Case{5, 9, 40}}) {
    const RowMatrix a = random_rows(c.rows, c.inner, 1), b = random_rows(c.inner, c.columns, 2);
    RowMatrix out = random_rows(2, 3, 3);  // previous contents are overwritten
    multiply(a, b, out);
    ASSERT_EQ(out.rows(), c.rows);
    ASSERT_EQ(out.cols(), c.columns);
    EXPECT_LT((out - a * b).cwiseAbs().maxCoeff(), kRounding * static_cast<double>(c.inner));
  }
}

TEST(RowProduct, IgnoresColumnsBeyondTheRowsOfTheOther) {
  RowMatrix a = random_rows(3, 6, 1);
  const RowMatrix b = random_rows(4, 8, 2);
  RowMatrix expected, out;
  multiply(a.leftCols(4), b, expected);
  a.rightCols(2).setConstant(std::numeric_limits<double>::quiet_NaN());
  multiply(a, b, out);
  EXPECT_EQ(out, expected);
}

TEST(RowGram, IsTheSumOfOuterProducts) {
  for (const Index columns : {1, 3, 4, 5, 8, 13}) {
    RowGram gram(columns);
    EXPECT_EQ(gram.sum(), MatrixXd::Zero(columns, columns));
    MatrixXd expected = MatrixXd::Zero(columns, columns);
    // Numbers of rows that grow and shrink: no earlier rows remain.
    for (const Index count : {1, 6, 2, 2, 9}) {
      const RowMatrix rows = random_rows(count, columns, static_cast<std::uint64_t>(count));
      gram.rows(count) = rows;
      gram.add();
      expected += rows.transpose() * rows;
    }
    EXPECT_LT((gram.sum() - expected).cwiseAbs().maxCoeff(), 20 * kRounding) << columns;
    EXPECT_EQ(gram.sum(), gram.sum().transpose());
  }
}

TEST(RowGram, PadsWithZeros) {
  constexpr Index kColumns = 6, kRows = 3;
  RowGram gram(kColumns);
  const RowMatrix rows = random_rows(kRows, kColumns, 4);
  gram.rows(kRows) = rows;
  ASSERT_EQ(gram.written().cols(), padded(static_cast<int>(kColumns)));
  EXPECT_EQ(gram.written().leftCols(kColumns), rows);
  EXPECT_TRUE(gram.written().rightCols(gram.written().cols() - kColumns).isZero(0));
}

TEST(RowGram, TheSumEqualsTheSumOfParts) {
  constexpr Index kColumns = 7, kBins = 50, kRows = 8;
  RowGram all(kColumns), even(kColumns), odd(kColumns);
  for (Index b = 0; b < kBins; ++b) {
    const RowMatrix rows = random_rows(kRows, kColumns, static_cast<std::uint64_t>(b));
    for (RowGram* gram : {&all, b % 2 == 0 ? &even : &odd}) {
      gram->rows(kRows) = rows;
      gram->add();
    }
  }
  EXPECT_LT((all.sum() - even.sum() - odd.sum()).cwiseAbs().maxCoeff(), kRounding * kBins * kRows);
}

TEST(RowGram, RowsMayBeginAtALaterColumn) {
  constexpr Index kColumns = 13;
  const RowMatrix all = random_rows(2, kColumns, 8), late = random_rows(3, kColumns, 9);
  for (const Index first : {0, 4, 8, 12}) {
    RowGram gram(kColumns);
    gram.rows(3, first) = late.rightCols(kColumns - first);
    gram.add();
    gram.rows(2) = all;
    gram.add();
    MatrixXd expected = all.transpose() * all;
    expected.bottomRightCorner(kColumns - first, kColumns - first) +=
        late.rightCols(kColumns - first).transpose() * late.rightCols(kColumns - first);
    EXPECT_LT((gram.sum() - expected).cwiseAbs().maxCoeff(), kRounding) << first;
  }
}

}  // namespace row_gram_test
}  // namespace framewatch::estimator
