// SPDX-License-Identifier: MIT
#include "estimator/numeric/kernels.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "estimator/simulate/random.h"

namespace framewatch::estimator {
namespace kernels_test {

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
      kernels::in_use->add_rows(source.data(), apart.data(), h.data(), rows, front, padded(front));
      kernels::in_use->add_rows(in_place.data(), in_place.data(), h.data(), rows, front,
                                padded(front));
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

TEST(Kernels, FilterRowsIsTheRecursionOfEveryRow) {
  const int stride = 20, rows = 3, at = 18;
  const double gain[rows] = {0.3, 0.5, 0.1}, a1[rows] = {-1.2, -0.3, 0.2},
               a2[rows] = {0.6, 0.1, 0.4};
  std::vector<double> s1(stride * rows, 0.0), s2 = s1, h = s1;
  const auto beta = random_values(stride * rows, 8);
  double t1[rows][stride] = {}, t2[rows][stride] = {};
  for (std::uint64_t t = 0; t < 50; ++t) {
    const auto x = random_values(stride, 100 + t), response = random_values(rows, 200 + t);
    kernels::in_use->filter_rows(x.data(), response.data(), at, gain, a1, a2, s1.data(), s2.data(),
                                 beta.data(), h.data(), rows, stride);
    for (int r = 0; r < rows; ++r) {
      for (int j = 0; j < stride; ++j) {
        const double input =
            j == at ? response[static_cast<std::size_t>(r)] : x[static_cast<std::size_t>(j)];
        const double s = gain[r] * input - a1[r] * t1[r][j] - a2[r] * t2[r][j];
        t2[r][j] = t1[r][j], t1[r][j] = s;
        const auto i = static_cast<std::size_t>(r * stride + j);
        ASSERT_NEAR(h[i], beta[i] * s, kRounding * 10);
      }
    }
  }
}

TEST(Kernels, SumIntoFrontUnpacks) {
  for (const int front : kFronts) {
    const auto a = random_values(packed_size(front), 1), b = random_values(packed_size(front), 2),
               c = random_values(packed_size(front), 3), n = random_values(packed_size(front), 4);
    const int stride = padded(front);
    std::vector<double> out(static_cast<std::size_t>(stride * stride));
    kernels::in_use->sum_into_front(a.data(), b.data(), c.data(), 0.7, n.data(), out.data(), front,
                                    stride);
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
      kernels::in_use->partial_cholesky(rows.data(), rows.data(), pivots, front, padded(front),
                                        least.data(), usable.data());
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

TEST(Kernels, ARejectedPivotLeavesOthersAlone) {
  for (const int bad : {0, 1, 2, 3, 4, 6}) {
    const int front = 9, pivots = 7;
    Eigen::MatrixXd a = positive(front);
    a.row(bad).setZero(), a.col(bad).setZero();
    auto rows = stored(a);
    const std::vector<double> least(pivots, 1e-12);
    std::vector<unsigned char> usable(pivots, 2);
    kernels::in_use->partial_cholesky(rows.data(), rows.data(), pivots, front, padded(front),
                                      least.data(), usable.data());
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

TEST(Kernels, SubstituteBackSolvesWithTheFactor) {
  for (const auto& [own, next] : {std::pair{10, 8}, {34, 16}, {4, 0}, {7, 6}}) {
    const int front = own + next + 1, stride = padded(front);
    auto rows = stored(positive(front));
    const std::vector<double> least(static_cast<std::size_t>(own), 0.0);
    std::vector<unsigned char> usable(static_cast<std::size_t>(own), 0);
    kernels::in_use->partial_cholesky(rows.data(), rows.data(), own, front, stride, least.data(),
                                      usable.data());
    auto x = random_values(static_cast<std::size_t>(own + next), 12);
    kernels::in_use->substitute_back(rows.data(), stride, own, next, x.data());
    for (int p = 0; p < own; ++p) {
      const double* row = &rows[static_cast<std::size_t>(p * stride)];
      double left = row[own + next];
      for (int j = p; j < own + next; ++j) left -= row[j] * x[static_cast<std::size_t>(j)];
      ASSERT_NEAR(left, 0, 1e-12 * std::abs(row[own + next]) + 1e-12);
    }
  }
}

/// Packed rows of a symmetric front, the entries left of the diagonal in its lane included.
std::vector<double> symmetric_packed(int front, std::uint64_t seed) {
  auto packed = random_values(packed_size(front), seed);
  std::size_t at = 0;
  for (int i = 0; i < front; ++i) {
    for (int j = packed_row_begin(i); j < i; ++j)
      packed[at + static_cast<std::size_t>(j - packed_row_begin(i))] =
          packed_at(packed, front, j, i);
    at += static_cast<std::size_t>(padded(front) - packed_row_begin(i));
  }
  return packed;
}

TEST(Kernels, SubtractProductMatchesTheWholeMatrix) {
  for (const int front : kFronts) {
    const int stride = padded(front);
    const auto packed = symmetric_packed(front, 21);
    auto x = random_values(static_cast<std::size_t>(stride), 22);
    for (int j = front; j < stride; ++j) x[static_cast<std::size_t>(j)] = 0;
    const auto before = random_values(static_cast<std::size_t>(stride), 23);
    auto score = before;
    kernels::in_use->subtract_product(packed.data(), x.data(), score.data(), front, stride);
    for (int i = 0; i < front; ++i) {
      double wanted = before[static_cast<std::size_t>(i)];
      for (int j = 0; j < front; ++j)
        wanted -= packed_at(packed, front, std::min(i, j), std::max(i, j)) *
                  x[static_cast<std::size_t>(j)];
      ASSERT_NEAR(score[static_cast<std::size_t>(i)], wanted, 1e-12) << front << " " << i;
    }
  }
}

/// Returns all results of the kernels for the same numbers, one after the other.
std::vector<double> all_results(const kernels::Table& table) {
  std::vector<double> out;
  const auto keep = [&](const std::vector<double>& v) {
    out.insert(out.end(), v.begin(), v.end());
  };
  for (const int front : kFronts) {
    for (const int rows : {0, 1, 3, 4, 8}) {
      auto sum = random_values(packed_size(front), 31);
      const auto h = padded_rows(rows, front);
      table.add_rows(sum.data(), sum.data(), h.data(), rows, front, padded(front));
      keep(sum);
    }
    const int stride = padded(front), own = front / 2, next = front - 1 - own;
    const auto a = random_values(packed_size(front), 32), b = random_values(packed_size(front), 33);
    std::vector<double> square(static_cast<std::size_t>(stride * stride), 0.0);
    table.sum_into_front(a.data(), b.data(), a.data(), 0.3, b.data(), square.data(), front, stride);
    keep(square);
    auto rows = stored(positive(front));
    const std::vector<double> least(static_cast<std::size_t>(own), 0.0);
    std::vector<unsigned char> usable(static_cast<std::size_t>(own), 0);
    table.partial_cholesky(rows.data(), rows.data(), own, front, stride, least.data(),
                           usable.data());
    keep(rows);
    auto x = random_values(static_cast<std::size_t>(front), 34);
    table.substitute_back(rows.data(), stride, own, next, x.data());
    keep(x);
    auto score = random_values(static_cast<std::size_t>(stride), 35);
    x = random_values(static_cast<std::size_t>(stride), 36);
    table.subtract_product(a.data(), x.data(), score.data(), front, stride);
    keep(score);
    for (const int columns : {4, 20, 40, 44}) {
      auto right = random_values(static_cast<std::size_t>(front * columns), 37);
      table.forward_columns(rows.data(), stride, own, next, right.data(), columns);
      keep(right);
      table.backward_columns(rows.data(), stride, own, next, right.data(), columns);
      keep(right);
      auto product = random_values(static_cast<std::size_t>(front * columns), 38);
      table.multiply_add(rows.data(), stride, front, front, right.data(), product.data(), columns);
      keep(product);
      table.add_two(0.7, right.data(), -1.3, right.data() + (front - 1) * columns, product.data(),
                    columns);
      keep(product);
    }
    const auto input = random_values(static_cast<std::size_t>(stride), 40);
    const auto beta = random_values(static_cast<std::size_t>(2 * stride), 41);
    auto s1 = random_values(static_cast<std::size_t>(2 * stride), 39), s2 = s1, filtered = s1;
    const double some[] = {0.2, -0.4};
    table.filter_rows(input.data(), beta.data(), front - 1, some, some, some, s1.data(), s2.data(),
                      beta.data(), filtered.data(), 2, stride);
    keep(s1), keep(s2), keep(filtered);
    constexpr int kTaps = 15;
    for (const int outputs : {kLane, 2 * kLane}) {
      const auto taps = random_values(static_cast<std::size_t>(kTaps * outputs), 42);
      std::vector<double> responses(static_cast<std::size_t>(outputs));
      table.apply_taps(taps.data(), random_values(kTaps, 43).data(), kTaps, outputs,
                       responses.data());
      keep(responses);
    }
    auto added = a;
    table.add(added.data(), b.data(), static_cast<long>(added.size()));
    keep(added);
  }
  return out;
}

/// All instruction sets must give the same bits, as stated in kernels.h.
TEST(Kernels, EveryInstructionSetGivesTheSameBits) {
  const std::vector<double> wanted = all_results(*kernels::portable());
  int others = 0;
  for (const kernels::Table* table : {kernels::x86_64_v3(), kernels::x86_64_v4()}) {
    if (table == nullptr) continue;
    ++others;
    const std::vector<double> got = all_results(*table);
    ASSERT_EQ(got.size(), wanted.size());
    for (std::size_t i = 0; i < got.size(); ++i)
      ASSERT_EQ(std::bit_cast<std::uint64_t>(got[i]), std::bit_cast<std::uint64_t>(wanted[i])) << i;
  }
  if (others == 0) GTEST_SKIP() << "this machine has one instruction set only";
}

// On arm64 the portable kernels are its only ones: their vectors are NEON's.
TEST(Kernels, PortableKernelsGiveTheSameBitsOnEveryArchitecture) {
  std::uint64_t digest = 1469598103934665603u;  // FNV-1a by words
  for (const double value : all_results(*kernels::portable()))
    digest = (digest ^ std::bit_cast<std::uint64_t>(value)) * 1099511628211u;
  EXPECT_EQ(digest, 0x65dadbd592e781c5u);
}

}  // namespace kernels_test
}  // namespace framewatch::estimator
