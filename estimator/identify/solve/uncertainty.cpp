// SPDX-License-Identifier: MIT
#include "estimator/identify/solve/uncertainty.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "estimator/identify/elements/guessed_design.h"
#include "estimator/numeric/kernels.h"

namespace framewatch::estimator {
namespace {

/// Batch means of 20 blocks understate the spread by a seventh, as measured (docs/accuracy.md).
constexpr double kCorrection = 1.155;

/// Returns the 97.5 % point of Student's t by Fisher's expansion, within a hundredth from 3 degrees
/// of freedom on.
double student(double n) {
  constexpr double z = 1.959964, z2 = z * z;
  return z * (1 + (z2 + 1) / (4 * n) + ((5 * z2 + 16) * z2 + 3) / (96 * n * n) +
              (((3 * z2 + 19) * z2 + 17) * z2 - 15) / (384 * n * n * n));
}

constexpr double kMinDegrees = 1.5;  // end of the expansion; below it no error is published

/// Returns the variance of a sum of this many scores over the sum of their squares about their
/// mean.
double spread_of(int blocks) {
  return kCorrection * kCorrection * blocks / (blocks - 1);
}

}  // namespace

BatchMeans::BatchMeans(const FloorLayout& layout, int most_blocks, double compensation)
    : layout_(layout),
      columns_(kBlocks + PerturbedDesigns::kCount),
      factor_(layout),
      inverse_(layout),
      noise_(layout, compensation),
      next_step_(steps()),
      block_(kBlocks, nullptr),
      holds_(static_cast<std::size_t>(layout.floors() * kBlocks), 0),
      perturbed_(layout) {
  static_assert(kBlocks % kLane == 0 && PerturbedDesigns::kCount % kLane == 0);
  block_.reserve(static_cast<std::size_t>(std::max(most_blocks, kBlocks)));
  const auto unknowns = static_cast<std::size_t>(layout.unknowns());
  columns_values_.assign(unknowns * static_cast<std::size_t>(columns_), 0.0);
  for (std::vector<double>* v :
       {&solution_, &score_scale_, &prior_, &prior_doubt_, &inverse_diagonal_, &new_error_,
        &new_share_, &new_noise_share_, &std_error_, &prior_share_, &noise_share_})
    v->assign(unknowns, 0.0);
  const auto front = static_cast<std::size_t>(padded(layout.most_front()));
  score_.assign(front, 0.0);
  x_.assign(front, 0.0);
}

void BatchMeans::begin(const GramShape& shape, StorySolver& solver, const Fit& fit,
                       const std::vector<double>& prior, const std::vector<double>& prior_doubt,
                       const NoiseCompensation& noise, double noise_level) {
  solver.swap_factor(factor_);
  solution_ = *fit.solution;
  for (std::size_t u = 0; u < score_scale_.size(); ++u)
    score_scale_[u] = (*fit.information)[u] > 0
                          ? std::sqrt(solver.information()[u] / (*fit.information)[u])
                          : 0.0;
  prior_ = prior;
  prior_doubt_ = prior_doubt;
  noise_ = noise;
  noise_level_ = noise_level;
  shape_ = &shape;
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
  add_bias_columns(floor);
}

/// Returns true if rows of a score hold the floor's own unknowns: rows of the floor or of the one
/// below.
bool BatchMeans::has_rows(int floor, int score) const {
  const auto holds = [&](int f) {
    return holds_[static_cast<std::size_t>(f * kBlocks + score)] != 0;
  };
  return holds(floor) || (floor > 0 && layout_.shared() > 0 && holds(floor - 1));
}

int BatchMeans::scores_with_rows(int floor) const {
  int scores = 0;
  for (int s = 0; s < kBlocks; ++s) scores += has_rows(floor, s) ? 1 : 0;
  return scores;
}

/// Returns the factor that widens the spread of few scores for a floor's own unknown.
double BatchMeans::widening(int floor, int position, int scores) const {
  if (scores < kFewest || scores == kBlocks) return 1;
  const GramShape::Floor& shape = shape_->floor[static_cast<std::size_t>(floor)];
  std::size_t at = shape.offset;
  for (int i = 0; i < position; ++i)
    at += static_cast<std::size_t>(shape.stride - packed_row_begin(i));
  at += static_cast<std::size_t>(position - packed_row_begin(position));
  std::array<double, kBlocks> information{};
  for (std::size_t b = 0; b < block_.size(); ++b)
    if (block_[b] != nullptr)
      information[static_cast<std::size_t>(score_of(static_cast<int>(b)))] += block_[b][at];
  double sum = 0, squares = 0;
  for (const double i : information) {
    sum += i;
    squares += i * i;
  }
  const double counting = squares > 0 ? sum * sum / squares : 1;
  return student(std::max(counting - 1, kMinDegrees)) / student(kBlocks - 1) *
         std::sqrt(spread_of(scores) / spread_of(kBlocks));
}

void BatchMeans::add_block_scores(int floor) {
  const GramShape::Floor& shape = shape_->floor[static_cast<std::size_t>(floor)];
  const int first = floor * layout_.own();
  const int unknowns = shape.front - 1;
  // The response is the front's last column, so x = [solution, -1] gives the residual.
  std::fill(x_.begin(), x_.end(), 0.0);
  std::copy_n(solution_.begin() + first, unknowns, x_.begin());
  x_[static_cast<std::size_t>(unknowns)] = -1;
  for (std::size_t b = 0; b < block_.size(); ++b) {
    if (block_[b] == nullptr) continue;
    const int s = score_of(static_cast<int>(b));
    std::fill(score_.begin(), score_.end(), 0.0);
    kernels::in_use->subtract_product(block_[b] + shape.offset, x_.data(), score_.data(),
                                      shape.front, shape.stride);
    for (int i = 0; i < unknowns; ++i) columns(first + i)[s] += score_[static_cast<std::size_t>(i)];
  }
  // The floor's own scores are now complete: the floor above has added its share.
  const int scores = scores_with_rows(floor);
  for (int u = first; u < first + layout_.own(); ++u) {
    double* row = columns(u);
    double mean = 0;
    for (int s = 0; s < kBlocks; ++s) mean += row[s];
    mean /= std::max(scores, 1);
    const double scale =
        score_scale_[static_cast<std::size_t>(u)] * widening(floor, u - first, scores);
    for (int s = 0; s < kBlocks; ++s) row[s] = has_rows(floor, s) ? scale * (row[s] - mean) : 0.0;
  }
}

void BatchMeans::add_bias_columns(int floor) {
  constexpr int kCount = PerturbedDesigns::kCount;
  const int first = floor * layout_.own();
  const NoiseCompensation::Part bias = noise_.bias(floor);
  if (bias.values != nullptr) {
    const double scale = noise_level_ * bias.scale;
    for (int i = 0; i < layout_.front(floor) - 1; ++i)
      for (int c = 0; c < kCount; ++c)
        columns(first + i)[kBlocks + c] += scale * bias.values[i * kCount + c];
  }
  const double* perturbation = perturbed_.floor(floor);
  for (int i = 0; i < layout_.own(); ++i)
    for (int c = 0; c < kCount; ++c)
      columns(first + i)[kBlocks + c] += prior_[static_cast<std::size_t>(first + i)] *
                                         prior_doubt_[static_cast<std::size_t>(first + i)] *
                                         perturbation[i * kCount + c];
}

void BatchMeans::finish(int floor) {
  inverse_.step(factor_, floor, inverse_diagonal_.data());
  const double spread_scale = spread_of(kBlocks);
  const bool enough = scores_with_rows(floor) >= kFewest;
  for (int u = floor * layout_.own(); u < (floor + 1) * layout_.own(); ++u) {
    const auto i = static_cast<std::size_t>(u);
    const double* row = columns(u);
    double spread = 0, bias = 0;
    for (int c = 0; c < kBlocks; ++c) spread += row[c] * row[c];
    for (int c = kBlocks; c < columns_; ++c) bias += row[c] * row[c];
    new_error_[i] = enough ? std::sqrt(spread_scale * spread + bias / PerturbedDesigns::kCount)
                           : std::numeric_limits<double>::infinity();
    new_share_[i] = prior_[i] * inverse_diagonal_[i];
    new_noise_share_[i] =
        noise_level_ * noise_.remaining_share() * noise_.energy()[i] * inverse_diagonal_[i];
  }
}

MassErrors::MassErrors(const FloorLayout& layout)
    : layout_(layout), factor_(layout), next_step_(2 * layout.floors()) {
  static_assert(kDraws % kLane == 0);
  const auto unknowns = static_cast<std::size_t>(layout.unknowns());
  columns_.assign(unknowns * kDraws, 0.0);
  new_error_.assign(unknowns, 0.0);
  error_.assign(unknowns, 0.0);
}

void MassErrors::begin(StorySolver& solver, const GramShape& shape, const std::vector<double>& sums,
                       double tolerance) {
  solver.swap_factor(factor_);
  shape_ = &shape;
  sums_ = sums.data();
  tolerance_ = tolerance;
  std::fill(columns_.begin(), columns_.end(), 0.0);
  next_step_ = 0;
}

/// Loads the floor's part of the right-hand side, times the error of its mass.
void MassErrors::load(int floor) {
  const GramShape::Floor& shape = shape_->floor[static_cast<std::size_t>(floor)];
  const int response = shape.front - 1;
  std::size_t at = shape.offset;
  for (int i = 0; i < response; ++i) {
    const int begin = packed_row_begin(i);
    const double right = sums_[at + static_cast<std::size_t>(response - begin)];
    double* to = column(floor * layout_.own() + i);
    for (int draw = 0; draw < kDraws; ++draw)
      to[draw] += tolerance_ * fixed_sign(floor, draw) * right;
    at += static_cast<std::size_t>(shape.stride - begin);
  }
}

bool MassErrors::advance(int count) {
  if (!running()) return false;
  for (; count > 0 && running(); --count, ++next_step_) {
    if (next_step_ < layout_.floors()) {
      load(next_step_);
      factor_.forward(next_step_, columns_.data(), kDraws);
    } else {
      const int floor = 2 * layout_.floors() - 1 - next_step_;
      factor_.backward(floor, columns_.data(), kDraws);
      finish(floor);
    }
  }
  if (running()) return false;
  error_.swap(new_error_);
  return true;
}

void MassErrors::finish(int floor) {
  for (int u = floor * layout_.own(); u < (floor + 1) * layout_.own(); ++u) {
    const double* row = column(u);
    double sum = 0;
    for (int draw = 0; draw < kDraws; ++draw) sum += row[draw] * row[draw];
    const double error = std::sqrt(sum / kDraws);
    new_error_[static_cast<std::size_t>(u)] = std::isfinite(error) ? error : 0;
  }
}

}  // namespace framewatch::estimator
