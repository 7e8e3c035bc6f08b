#include "estimator/identify/kernels.h"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "estimator/identify/row_tuning.h"
#include "estimator/simulate/random.h"

namespace framewatch {
namespace {

constexpr double kRounding = 1e-14;
constexpr int kFronts[] = {2, 3, 5, 10, 11, 15, 17, 43, 51};

std::vector<double> random_values(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<double> out(count);
  for (double& v : out) v = random.normal();
  return out;
}

/// Rows of `front` values, padded with zeros.
std::vector<double> padded_rows(int rows, int front) {
  auto h = random_values(static_cast<std::size_t>(rows * padded(front)), 5);
  for (int r = 0; r < rows; ++r)
    for (int j = front; j < padded(front); ++j)
      h[static_cast<std::size_t>(r * padded(front) + j)] = 0;
  return h;
}

std::size_t packed_size(int front) {
  std::size_t size = 0;
  for (int i = 0; i < front; ++i)
    size += static_cast<std::size_t>(padded(front) - packed_row_begin(i));
  return size;
}

/// Entry (i, j), j >= i, of packed rows.
double packed_at(const std::vector<double>& packed, int front, int i, int j) {
  std::size_t at = 0;
  for (int k = 0; k < i; ++k) at += static_cast<std::size_t>(padded(front) - packed_row_begin(k));
  return packed[at + static_cast<std::size_t>(j - packed_row_begin(i))];
}

TEST(Kernels, AddRowsAddsTheirOuterProducts) {
  for (const int front : kFronts) {
    for (int rows = 0; rows <= 9; ++rows) {
      const auto h = padded_rows(rows, front);
      const auto source = random_values(packed_size(front), 6);
      auto apart = random_values(packed_size(front), 7);
      auto in_place = source;
      kernels::add_rows(source.data(), apart.data(), h.data(), rows, front, padded(front));
      kernels::add_rows(in_place.data(), in_place.data(), h.data(), rows, front, padded(front));
      for (int i = 0; i < front; ++i) {
        for (int j = i; j < front; ++j) {
          double sum = packed_at(source, front, i, j), scale = std::abs(sum);
          for (int r = 0; r < rows; ++r) {
            const double product = h[static_cast<std::size_t>(r * padded(front) + i)] *
                                   h[static_cast<std::size_t>(r * padded(front) + j)];
            sum += product;
            scale += std::abs(product);
          }
          ASSERT_NEAR(packed_at(apart, front, i, j), sum, kRounding * scale);
        }
      }
      ASSERT_EQ(apart, in_place) << front << " " << rows;
    }
  }
}

TEST(Kernels, FilterRowIsItsRecursion) {
  const int length = 20;
  std::vector<double> s1(length, 0.0), s2 = s1, h = s1;
  const auto beta = random_values(length, 8);
  double t1 = 0, t2 = 0;
  for (int t = 0; t < 50; ++t) {
    const auto x = random_values(length, 100 + static_cast<std::uint64_t>(t));
    kernels::filter_row(x.data(), 0.3, -1.2, 0.6, s1.data(), s2.data(), beta.data(), h.data(),
                        length);
    const double s = 0.3 * x[13] + 1.2 * t1 - 0.6 * t2;
    t2 = t1, t1 = s;
    ASSERT_NEAR(h[13], beta[13] * s, kRounding * 10);
  }
}

TEST(Kernels, SumIntoFrontUnpacks) {
  for (const int front : kFronts) {
    const auto a = random_values(packed_size(front), 1), b = random_values(packed_size(front), 2),
               c = random_values(packed_size(front), 3), n = random_values(packed_size(front), 4);
    const int stride = padded(front);
    std::vector<double> out(static_cast<std::size_t>(stride * stride));
    kernels::sum_into_front(a.data(), b.data(), c.data(), 0.7, n.data(), out.data(), front, stride);
    for (int i = 0; i < front; ++i)
      for (int j = i; j < front; ++j)
        ASSERT_NEAR(out[static_cast<std::size_t>(i * stride + j)],
                    packed_at(a, front, i, j) + packed_at(b, front, i, j) +
                        packed_at(c, front, i, j) - 0.7 * packed_at(n, front, i, j),
                    kRounding * 10);
  }
}

/// A random positive definite front in the kernel's storage.
Eigen::MatrixXd positive(int front) {
  const Eigen::Index n = front;
  const auto values = random_values(static_cast<std::size_t>(2 * n * n), 9);
  const Eigen::Map<const Eigen::MatrixXd> x(values.data(), 2 * n, n);
  return x.transpose() * x;
}
std::vector<double> stored(const Eigen::MatrixXd& a) {
  const auto front = static_cast<int>(a.rows());
  const int stride = padded(front);
  std::vector<double> out(static_cast<std::size_t>(stride * stride), 0.0);
  for (int i = 0; i < front; ++i)
    for (int j = i; j < front; ++j) out[static_cast<std::size_t>(i * stride + j)] = a(i, j);
  return out;
}

TEST(Kernels, PartialCholeskyIsFactorAndSchurComplement) {
  for (const int front : kFronts) {
    for (const int pivots : {1, front / 2, front - 1}) {
      const Eigen::MatrixXd a = positive(front);
      auto rows = stored(a);
      const std::vector<double> least(static_cast<std::size_t>(pivots), 0.0);
      std::vector<unsigned char> usable(static_cast<std::size_t>(pivots), 0);
      kernels::partial_cholesky(rows.data(), pivots, front, padded(front), least.data(),
                                usable.data());
      const Eigen::MatrixXd u =
          a.topLeftCorner(pivots, pivots).llt().matrixL().transpose().toDenseMatrix();
      const int rest = front - pivots;
      const Eigen::MatrixXd v =
          u.transpose().triangularView<Eigen::Lower>().solve(a.topRightCorner(pivots, rest));
      const Eigen::MatrixXd schur = a.bottomRightCorner(rest, rest) - v.transpose() * v;
      for (int i = 0; i < front; ++i) {
        for (int j = i; j < front; ++j) {
          const double wanted = i >= pivots  ? schur(i - pivots, j - pivots)
                                : j < pivots ? u(i, j)
                                             : v(i, j - pivots);
          ASSERT_NEAR(rows[static_cast<std::size_t>(i * padded(front) + j)], wanted,
                      1e-12 * a.norm());
        }
      }
      for (const unsigned char one : usable) EXPECT_EQ(one, 1);
    }
  }
}

TEST(Kernels, GivenUpPivotLeavesTheOthersAlone) {
  for (const int bad : {0, 1, 2, 3, 4, 6}) {
    const int front = 9, pivots = 7;
    Eigen::MatrixXd a = positive(front);
    a.row(bad).setZero(), a.col(bad).setZero();
    auto rows = stored(a);
    const std::vector<double> least(pivots, 1e-12);
    std::vector<unsigned char> usable(pivots, 2);
    kernels::partial_cholesky(rows.data(), pivots, front, padded(front), least.data(),
                              usable.data());
    for (int p = 0; p < pivots; ++p) EXPECT_EQ(usable[static_cast<std::size_t>(p)], p != bad);
    for (int j = bad; j < front; ++j)
      EXPECT_EQ(rows[static_cast<std::size_t>(bad * padded(front) + j)], 0);
    std::vector<int> kept;
    for (int p = 0; p < pivots; ++p)
      if (p != bad) kept.push_back(p);
    const Eigen::MatrixXd own = a(kept, kept), side = a(kept, Eigen::lastN(2));
    const Eigen::MatrixXd schur =
        a.bottomRightCorner(2, 2) - side.transpose() * own.ldlt().solve(side);
    for (int i = 0; i < 2; ++i)
      for (int j = i; j < 2; ++j)
        EXPECT_NEAR(rows[static_cast<std::size_t>((7 + i) * padded(front) + 7 + j)], schur(i, j),
                    1e-12 * a.norm());
  }
}

}  // namespace
}  // namespace framewatch
