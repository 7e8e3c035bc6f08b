#include "estimator/identify/uncertainty.h"

#include <algorithm>
#include <cmath>

namespace framewatch {
namespace {

/// Measured: batch means of 20 blocks understate the spread by a tenth (docs/accuracy.md).
constexpr double kCorrection = 1.1;

}  // namespace

BatchMeans::BatchMeans(const FloorLayout& layout, int blocks) : layout_(layout), blocks_(blocks) {
  scores_.assign(static_cast<std::size_t>(layout.unknowns() * blocks), 0.0);
  std_error_.assign(static_cast<std::size_t>(layout.unknowns()), 0.0);
}

void BatchMeans::compute(const WindowSums& sums, const StorySolver& solver) {
  std::fill(scores_.begin(), scores_.end(), 0.0);
  const std::vector<double>& x = solver.solution();
  const int own = layout_.own();
  for (int b = 0; b < blocks_; ++b) {
    const double* block = sums.block(b);
    for (int floor = 0; floor < layout_.floors(); ++floor) {
      const SumsShape::Floor& shape = sums.shape().floor[static_cast<std::size_t>(floor)];
      const double* row = block + shape.offset;
      const int unknowns = shape.front - 1;
      const double* xf = &x[static_cast<std::size_t>(floor * own)];
      const auto score = [&](int i) -> double& {
        return scores_[static_cast<std::size_t>((floor * own + i) * blocks_ + b)];
      };
      for (int i = 0; i < unknowns; ++i) {
        const double* a = row - i / kLane * kLane;
        double sum = a[unknowns] - a[i] * xf[i];
        for (int j = i + 1; j < unknowns; ++j) {
          sum -= a[j] * xf[j];
          score(j) -= a[j] * xf[i];
        }
        score(i) += sum;
        row += shape.stride - i / kLane * kLane;
      }
    }
  }
  solver.solve(scores_, blocks_);
  for (int u = 0; u < layout_.unknowns(); ++u) {
    double sum = 0;
    for (int b = 0; b < blocks_; ++b) {
      const double part = scores_[static_cast<std::size_t>(u * blocks_ + b)];
      sum += part * part;
    }
    std_error_[static_cast<std::size_t>(u)] = kCorrection * std::sqrt(sum);
  }
}

}  // namespace framewatch
