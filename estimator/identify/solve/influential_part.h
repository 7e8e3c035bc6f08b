// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "estimator/identify/elements/floor_layout.h"
#include "estimator/identify/gram/sliding_gram.h"
#include "estimator/identify/solve/noise_compensation.h"
#include "estimator/identify/solve/story_solver.h"

namespace framewatch::estimator {

/// Measures how far a window's solution moves when its most influential fifth is left out.
///
/// The spread of a window's blocks says little when one of them carries nearly all information, as
/// an absurd sample does: the solution fits that block, and its residual is small. So the window is
/// solved once more without the consecutive blocks, a fifth of its length, that have the largest
/// share of an unknown's information. docs/equations.md, influential part.
///
/// A pass begins when a block closes and takes steps(), spread over the instants of the next block.
class InfluentialPart {
 public:
  static constexpr double kExplained = 2;  ///< errors that noise alone exceeds in 5 of 100 cases

  /// most_blocks: most blocks of a window. compensation: share of the noise, see
  /// NoiseCompensation.
  InfluentialPart(const FloorLayout& layout, int most_blocks, double compensation);

  /// Begins a pass. sums: as for BatchMeans. blocks: number of blocks in the window, newest first
  /// in `sums`. solver, prior, centre, noise: those of the solution. The blocks must be kept until
  /// the pass is done.
  template <typename Sums>
  void begin(const Sums& sums, int blocks, const StorySolver& solver,
             const std::vector<double>& prior, const std::vector<double>& centre,
             const NoiseCompensation& noise) {
    block_.assign(static_cast<std::size_t>(blocks), nullptr);
    for (int b = 0; b < blocks; ++b) block_[static_cast<std::size_t>(b)] = sums.block(b);
    const int part = std::max(1, blocks / kParts);
    const int first = most_influential(sums.shape(), part);
    for (int f = 0; f < layout_.floors(); ++f) {
      int all = 0, kept = 0;
      for (int b = 0; b < blocks; ++b) {
        if (block_[static_cast<std::size_t>(b)] == nullptr || !sums.holds(b, f)) continue;
        ++all;
        if (b < first || b >= first + part) ++kept;
      }
      kept_[static_cast<std::size_t>(f)] = all > 0 ? static_cast<double>(kept) / all : 0;
    }
    block_.erase(block_.begin() + first, block_.begin() + first + part);
    begin(sums.shape(), solver, prior, centre, noise);
  }
  int steps() const { return layout_.floors() + 1; }
  bool running() const { return next_step_ < steps(); }
  /// Advances by at most `count` steps.
  void advance(int count);
  /// Starts anew with the results of a solution that has no influential part.
  void restart(const std::vector<double>& solution) {
    cancel();
    solution_ = solution;
    std::fill(move_.begin(), move_.end(), 0.0);
  }
  /// Abandons the pass in progress, if any. Results remain.
  void cancel() { next_step_ = steps(); }

  /// Returns the solution of the last pass, or of the pass in progress.
  const std::vector<double>& solution() const { return solution_; }
  /// Returns the standard error of an unknown that has the standard error `spread` by the spread of
  /// its blocks: the move of the solution beyond kExplained errors of that move, if it is larger.
  double error(int unknown, double spread) const {
    const auto u = static_cast<std::size_t>(unknown);
    return std::max(spread, move_[u] - kExplained * noise_of_move_[u] * spread);
  }

  /// sums: those of the pass in progress, if any.
  void archive(auto& a, const RowFilter& rows, const auto& sums) {
    a.within(next_step_, 0, steps());
    noise_.archive(a, rows);
    shape_ = &sums.shape();
    std::int64_t blocks = running() ? static_cast<std::int64_t>(block_.size()) : 0;
    a.within(blocks, 0, kMaxBlocks);
    block_.resize(static_cast<std::size_t>(blocks), nullptr);
    for (const double*& block : block_) {
      std::int64_t number = sums.number_of(block);
      a(number);
      block = sums.block_of(number);
    }
    a(sum_, kept_, prior_, centre_, solution_, information_, move_, noise_of_move_);
    if (running() && !noise_.known()) a.refuse();
  }

 private:
  static constexpr int kParts = 5, kMaxBlocks = 1 << 20;
  int most_influential(const GramShape& shape, int part);
  void begin(const GramShape& shape, const StorySolver& solver, const std::vector<double>& prior,
             const std::vector<double>& centre, const NoiseCompensation& noise);
  void add_blocks(int floor);
  void solve();

  FloorLayout layout_;
  StorySolver solver_;
  NoiseCompensation noise_;
  const GramShape* shape_ = nullptr;
  std::vector<const double*> block_;  ///< those that are kept; nullptr: before the start
  std::vector<double> sum_, zero_;
  std::vector<double> kept_;  ///< by floor: share of the blocks with rows that are kept
  std::vector<int> instants_;
  std::vector<double> prior_, centre_, solution_, information_, total_;
  std::vector<double> move_;           ///< by unknown, relative to theta0
  std::vector<double> noise_of_move_;  ///< its error from noise, in standard errors of the window
  int next_step_;
};

}  // namespace framewatch::estimator
