#include "estimator/identify/uncertainty.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace framewatch {
namespace {

/// Measured: batch means of 20 blocks understate the spread by a tenth (docs/accuracy.md).
constexpr double kCorrection = 1.1;
/// Designs, wrong by their tolerance in random directions, whose pull is averaged.
constexpr int kWrongDesigns = 20;
/// Standard deviation of a design that is off by anything up to its tolerance, over the tolerance.
constexpr double kUniform = 0.58;

/// A fixed random sign: the same on every run and machine (splitmix64).
double sign(int row, int column) {
  std::uint64_t z = (static_cast<std::uint64_t>(row) << 20) + static_cast<std::uint64_t>(column);
  z += 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  return ((z ^ (z >> 31)) & 1) != 0 ? 1.0 : -1.0;
}

}  // namespace

BatchMeans::BatchMeans(const FloorLayout& layout, int blocks, const std::vector<double>& tolerance)
    : layout_(layout), blocks_(blocks), columns_(blocks + kWrongDesigns), tolerance_(tolerance) {
  const auto unknowns = static_cast<std::size_t>(layout.unknowns());
  columns_values_.assign(unknowns * static_cast<std::size_t>(columns_), 0.0);
  std_error_.assign(unknowns, 0.0);
  wrong_.assign(unknowns, 0.0);
  pulled_.assign(unknowns, 0.0);
}

void BatchMeans::compute(const WindowSums& sums, const StorySolver& solver,
                         const std::vector<double>& prior, const NoiseShare& noise,
                         double noise_level) {
  std::fill(columns_values_.begin(), columns_values_.end(), 0.0);
  add_block_scores(sums, solver.solution());
  add_pulls(prior, noise, noise_level);
  solver.solve(columns_values_, columns_);
  const double spread_scale = kCorrection * kCorrection * blocks_ / (blocks_ - 1);
  for (int u = 0; u < layout_.unknowns(); ++u) {
    const double* row = &columns_values_[static_cast<std::size_t>(u * columns_)];
    double spread = 0, pull = 0;
    for (int c = 0; c < blocks_; ++c) spread += row[c] * row[c];
    for (int c = blocks_; c < columns_; ++c) pull += row[c] * row[c] / kWrongDesigns;
    std_error_[static_cast<std::size_t>(u)] = std::sqrt(spread_scale * spread + pull);
  }
}

void BatchMeans::add_block_scores(const WindowSums& sums, const std::vector<double>& x) {
  const int own = layout_.own();
  for (int b = 0; b < blocks_; ++b) {
    const double* block = sums.block(b);
    for (int floor = 0; floor < layout_.floors(); ++floor) {
      const SumsShape::Floor& shape = sums.shape().floor[static_cast<std::size_t>(floor)];
      const double* row = block + shape.offset;
      const int unknowns = shape.front - 1;
      const double* xf = &x[static_cast<std::size_t>(floor * own)];
      const auto score = [&](int i) -> double& {
        return columns_values_[static_cast<std::size_t>((floor * own + i) * columns_ + b)];
      };
      for (int i = 0; i < unknowns; ++i) {
        const double* a = row - packed_row_begin(i);
        double sum = a[unknowns] - a[i] * xf[i];
        for (int j = i + 1; j < unknowns; ++j) {
          sum -= a[j] * xf[j];
          score(j) -= a[j] * xf[i];
        }
        score(i) += sum;
        row += shape.stride - packed_row_begin(i);
      }
    }
  }
  for (int u = 0; u < layout_.unknowns(); ++u) {
    double* row = &columns_values_[static_cast<std::size_t>(u * columns_)];
    double mean = 0;
    for (int b = 0; b < blocks_; ++b) mean += row[b] / blocks_;
    for (int b = 0; b < blocks_; ++b) row[b] -= mean;
  }
}

void BatchMeans::add_pulls(const std::vector<double>& prior, const NoiseShare& noise,
                           double noise_level) {
  for (int c = 0; c < kWrongDesigns; ++c) {
    for (std::size_t u = 0; u < wrong_.size(); ++u) {
      wrong_[u] = kUniform * tolerance_[u] * sign(static_cast<int>(u), c);
      pulled_[u] = 0;
    }
    noise.add_remaining(wrong_, pulled_);
    for (std::size_t u = 0; u < wrong_.size(); ++u)
      columns_values_[u * static_cast<std::size_t>(columns_) +
                      static_cast<std::size_t>(blocks_ + c)] =
          noise_level * pulled_[u] + prior[u] * wrong_[u];
  }
}

}  // namespace framewatch
