#include "estimator/identify/uncertainty.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "estimator/identify/kernels.h"

namespace framewatch {
namespace {

/// Measured: batch means of 20 blocks understate the spread by a seventh (docs/accuracy.md).
constexpr double kCorrection = 1.155;
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

BatchMeans::BatchMeans(const FloorLayout& layout, const std::vector<double>& tolerance)
    : layout_(layout),
      columns_(kBlocks + kWrongDesigns),
      factor_(layout),
      inverse_(layout),
      noise_(layout),
      next_step_(steps()),
      block_(kBlocks, nullptr) {
  static_assert(kBlocks % kLane == 0 && kWrongDesigns % kLane == 0);
  const auto unknowns = static_cast<std::size_t>(layout.unknowns());
  columns_values_.assign(unknowns * static_cast<std::size_t>(columns_), 0.0);
  for (std::vector<double>* v :
       {&solution_, &score_scale_, &prior_, &inverse_diagonal_, &new_error_, &new_share_,
        &new_noise_share_, &std_error_, &prior_share_, &noise_share_})
    v->assign(unknowns, 0.0);
  const auto front = static_cast<std::size_t>(padded(layout.own() + 2 * layout.frames() + 1));
  score_.assign(front, 0.0);
  x_.assign(front, 0.0);
  pulled_.assign(front * kWrongDesigns, 0.0);
  for (std::size_t u = 0; u < unknowns; ++u)
    for (int c = 0; c < kWrongDesigns; ++c)
      wrong_.push_back(kUniform * tolerance[u] * sign(static_cast<int>(u), c));
}

void BatchMeans::begin(const WindowSums& sums, StorySolver& solver, const Fit& fit,
                       const std::vector<double>& prior, const NoiseShare& noise,
                       double noise_level) {
  solver.swap_factor(factor_);
  solution_ = *fit.solution;
  for (std::size_t u = 0; u < score_scale_.size(); ++u)
    score_scale_[u] = (*fit.information)[u] > 0
                          ? std::sqrt(solver.information()[u] / (*fit.information)[u])
                          : 0.0;
  prior_ = prior;
  noise_ = noise;
  noise_level_ = noise_level;
  shape_ = &sums.shape();
  for (int b = 0; b < kBlocks; ++b) block_[static_cast<std::size_t>(b)] = sums.block(b);
  std::fill(columns_values_.begin(), columns_values_.end(), 0.0);
  next_step_ = 0;
}

bool BatchMeans::advance(int count) {
  if (!running()) return false;
  for (; count > 0 && running(); --count, ++next_step_) {
    const bool up = next_step_ < layout_.floors();
    const int floor = up ? next_step_ : 2 * layout_.floors() - 1 - next_step_;
    if (up) {
      assemble(floor);
      factor_.forward(floor, columns_values_.data(), columns_);
    } else {
      factor_.backward(floor, columns_values_.data(), columns_);
      finish(floor);
    }
  }
  if (running()) return false;
  std_error_.swap(new_error_);
  prior_share_.swap(new_share_);
  noise_share_.swap(new_noise_share_);
  return true;
}

void BatchMeans::assemble(int floor) {
  const auto clear = [&](int f) {
    std::fill(columns(f * layout_.own()), columns((f + 1) * layout_.own()), 0.0);
  };
  if (floor == 0) clear(0);
  if (floor + 1 < layout_.floors()) clear(floor + 1);
  add_block_scores(floor);
  add_pulls(floor);
}

void BatchMeans::add_block_scores(int floor) {
  const SumsShape::Floor& shape = shape_->floor[static_cast<std::size_t>(floor)];
  const int first = floor * layout_.own();
  const int unknowns = shape.front - 1;
  // The response is the front's last column: x = [solution, -1] leaves its residual.
  std::fill(x_.begin(), x_.end(), 0.0);
  std::copy_n(solution_.begin() + first, unknowns, x_.begin());
  x_[static_cast<std::size_t>(unknowns)] = -1;
  for (int b = 0; b < kBlocks; ++b) {
    std::fill(score_.begin(), score_.end(), 0.0);
    kernels::in_use->subtract_product(block_[static_cast<std::size_t>(b)] + shape.offset, x_.data(),
                                      score_.data(), shape.front, shape.stride);
    for (int i = 0; i < unknowns; ++i) columns(first + i)[b] += score_[static_cast<std::size_t>(i)];
  }
  // The floor's own scores are now whole: what the story above adds went to that story's.
  for (int u = first; u < first + layout_.own(); ++u) {
    double* row = columns(u);
    double mean = 0;
    for (int b = 0; b < kBlocks; ++b) mean += row[b];
    mean /= kBlocks;
    const double scale = score_scale_[static_cast<std::size_t>(u)];
    for (int b = 0; b < kBlocks; ++b) row[b] = scale * (row[b] - mean);
  }
}

void BatchMeans::add_pulls(int floor) {
  const int first = floor * layout_.own();
  const int unknowns = layout_.front(floor) - 1;
  const double* wrong = &wrong_[static_cast<std::size_t>(first * kWrongDesigns)];
  const NoiseShare::Part left = noise_.left(floor);
  if (left.values != nullptr) {
    std::fill(pulled_.begin(), pulled_.end(), 0.0);
    kernels::in_use->multiply_add(left.values, unknowns, unknowns, unknowns, wrong, pulled_.data(),
                                  kWrongDesigns);
    const double scale = noise_level_ * left.scale;
    for (int i = 0; i < unknowns; ++i)
      for (int c = 0; c < kWrongDesigns; ++c)
        columns(first + i)[kBlocks + c] +=
            scale * pulled_[static_cast<std::size_t>(i * kWrongDesigns + c)];
  }
  for (int i = 0; i < layout_.own(); ++i)
    for (int c = 0; c < kWrongDesigns; ++c)
      columns(first + i)[kBlocks + c] +=
          prior_[static_cast<std::size_t>(first + i)] * wrong[i * kWrongDesigns + c];
}

void BatchMeans::finish(int floor) {
  inverse_.step(factor_, floor, inverse_diagonal_.data());
  const double spread_scale = kCorrection * kCorrection * kBlocks / (kBlocks - 1);
  for (int u = floor * layout_.own(); u < (floor + 1) * layout_.own(); ++u) {
    const auto i = static_cast<std::size_t>(u);
    const double* row = columns(u);
    double spread = 0, pull = 0;
    for (int c = 0; c < kBlocks; ++c) spread += row[c] * row[c];
    for (int c = kBlocks; c < columns_; ++c) pull += row[c] * row[c];
    new_error_[i] = std::sqrt(spread_scale * spread + pull / kWrongDesigns);
    new_share_[i] = prior_[i] * inverse_diagonal_[i];
    new_noise_share_[i] =
        noise_level_ * noise_.left_share() * noise_.energy()[i] * inverse_diagonal_[i];
  }
}

}  // namespace framewatch
