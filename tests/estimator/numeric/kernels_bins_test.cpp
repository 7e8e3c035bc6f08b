// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "estimator/numeric/kernels.h"
#include "estimator/simulate/random.h"

namespace framewatch::estimator {
namespace kernels_bins_test {

using kernels::kBins;
constexpr int kNumber = 2 * kBins;

/// Each row has its own axes. With a `band` other than zero, entries far from the diagonal are
/// zero.
struct Case {
  int n, axes;
  std::vector<double> d, noise;
  std::vector<int> first, end;        ///< range of the row's axes
  std::vector<int> covariance_first;  ///< first column of the covariance

  Case(int equations, int sensors, int band = 0) : n(equations), axes(sensors) {
    Random random(static_cast<std::uint64_t>(100 * equations + sensors));
    for (int i = 0; i < n; ++i) {
      first.push_back(band > 0 ? std::max(0, i - band) : 0);
      end.push_back(band > 0 ? std::min(axes, i + band + 1) : axes);
      covariance_first.push_back(band > 0 ? std::max(0, i - 2 * band) : 0);
      for (int a = 0; a < axes; ++a)
        for (int k = 0; k < kNumber; ++k) {
          const double any = random.normal();
          d.push_back(a >= first.back() && a < end.back() ? any : 0.0);
        }
    }
    for (int i = 0; i < axes * kBins; ++i) noise.push_back(0.1 + random.uniform());
  }

  std::vector<double> covariance(const kernels::Table& table) const {
    std::vector<double> out(static_cast<std::size_t>(n * n * kNumber), 0.0);
    table.noise_covariance(d.data(), noise.data(), first.data(), end.data(), n, axes, out.data());
    return out;
  }
};

Eigen::MatrixXcd at_bin(const std::vector<double>& numbers, int rows, int columns, int bin) {
  Eigen::MatrixXcd out(rows, columns);
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      const double* number = &numbers[static_cast<std::size_t>((i * columns + j) * kNumber + bin)];
      out(i, j) = {number[0], number[kBins]};
    }
  return out;
}

TEST(KernelsOfBins, InverseFactorWhitensTheNoise) {
  constexpr double kRounding = 1e-12;
  for (const Case& c : {Case(1, 2), Case(8, 10), Case(17, 20), Case(17, 17, 3)}) {
    const int n = c.n, axes = c.axes;
    std::vector<double> matrix = c.covariance(*kernels::in_use);
    kernels::in_use->inverse_cholesky(matrix.data(), c.covariance_first.data(), n);
    for (int bin = 0; bin < kBins; ++bin) {
      const Eigen::MatrixXcd d = at_bin(c.d, n, axes, bin);
      Eigen::VectorXd noise(axes);
      for (int a = 0; a < axes; ++a) noise[a] = c.noise[static_cast<std::size_t>(a * kBins + bin)];
      const Eigen::MatrixXcd w =
          at_bin(matrix, n, n, bin).triangularView<Eigen::Lower>().toDenseMatrix();
      const Eigen::MatrixXcd white = w * d * noise.asDiagonal() * d.adjoint() * w.adjoint();
      EXPECT_LT((white - Eigen::MatrixXcd::Identity(n, n)).norm(), kRounding * n)
          << n << " " << bin;
    }
  }
}

TEST(KernelsOfBins, GiveNanForAnIndefiniteMatrix) {
  std::vector<double> matrix(4 * kNumber, 0.0);
  for (int bin = 0; bin < kBins; ++bin) {
    matrix[static_cast<std::size_t>(bin)] = 1;                // (0, 0)
    matrix[static_cast<std::size_t>(2 * kNumber + bin)] = 2;  // (1, 0)
    matrix[static_cast<std::size_t>(3 * kNumber + bin)] = bin == 3 ? 5 : 1;
  }
  const int first[] = {0, 0};
  kernels::in_use->inverse_cholesky(matrix.data(), first, 2);
  for (int bin = 0; bin < kBins; ++bin)
    EXPECT_EQ(std::isfinite(matrix[static_cast<std::size_t>(3 * kNumber + bin)]), bin == 3);
}

TEST(KernelsOfBins, EveryInstructionSetGivesTheSameBits) {
  int others = 0;
  for (const kernels::Table* table : {kernels::x86_64_v3(), kernels::x86_64_v4()}) {
    if (table == nullptr) continue;
    ++others;
    for (const Case& c : {Case(1, 2), Case(8, 10), Case(17, 20), Case(17, 17, 3)}) {
      std::vector<double> wanted = c.covariance(*kernels::portable()), got = c.covariance(*table);
      kernels::portable()->inverse_cholesky(wanted.data(), c.covariance_first.data(), c.n);
      table->inverse_cholesky(got.data(), c.covariance_first.data(), c.n);
      for (std::size_t i = 0; i < got.size(); ++i)
        ASSERT_EQ(std::bit_cast<std::uint64_t>(got[i]), std::bit_cast<std::uint64_t>(wanted[i]));
    }
  }
  if (others == 0) GTEST_SKIP() << "this machine has one instruction set only";
}

// On arm64 the portable kernels are its only ones: their vectors are NEON's.
TEST(KernelsOfBins, PortableKernelsGiveTheSameBitsOnEveryArchitecture) {
  std::uint64_t digest = 1469598103934665603u;  // FNV-1a by words
  for (const Case& c : {Case(1, 2), Case(8, 10), Case(17, 20), Case(17, 17, 3)}) {
    std::vector<double> matrix = c.covariance(*kernels::portable());
    kernels::portable()->inverse_cholesky(matrix.data(), c.covariance_first.data(), c.n);
    for (const double value : matrix)
      digest = (digest ^ std::bit_cast<std::uint64_t>(value)) * 1099511628211u;
  }
  EXPECT_EQ(digest, 0x1d2dd9eebcea6db9u);
}

}  // namespace kernels_bins_test
}  // namespace framewatch::estimator
