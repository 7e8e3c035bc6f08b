// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "estimator/identify/elements/floor_layout.h"
#include "estimator/identify/elements/guessed_design.h"
#include "estimator/identify/gram/sliding_gram.h"
#include "estimator/identify/solve/noise_compensation.h"
#include "estimator/identify/solve/story_solver.h"

namespace framewatch::estimator {

/// Computes the standard deviation of every relative unknown from spread and bias.
/// docs/equations.md, batch means.
///
/// The spread comes from batch means: the scores of the window's blocks are carried through the
/// factored normal equations. Blocks are nearly independent, although the residuals inside a block
/// are not. The bias is how far prior and noise can move the solution toward a design that is off
/// by its tolerance.
///
/// A pass begins when a block closes and takes steps(), spread over the instants of the next block,
/// so that no instant is late. Results are those of the last completed pass. The spread is that of
/// kBlocks scores. A window of more blocks adds the scores of neighbouring blocks, so that every
/// part of it counts. A short window has too few blocks, so it uses the scores of the newest
/// kBlocks blocks and a solution that fits them, scaled to its own information.
///
/// While fewer blocks have rows, the spread comes from those and is widened by Student's
/// distribution, with as many degrees of freedom as blocks count: the last blocks of a motion that
/// has just begun carry nearly all information. With fewer than kFewest blocks, the error is
/// infinite.
class BatchMeans {
 public:
  static constexpr int kBlocks = 20, kFewest = 4;

  /// most_blocks: most blocks of a window. compensation: share of the noise, see
  /// NoiseCompensation.
  BatchMeans(const FloorLayout& layout, int most_blocks, double compensation = kCompensatedShare);

  /// The window of `blocks` blocks, at least kBlocks, by the solution that fits it and its
  /// information.
  struct Fit {
    int blocks;
    const std::vector<double>* solution;
    const std::vector<double>* information;
  };
  /// Begins a pass. It takes the solver's factor and leaves the solution there.
  ///
  /// sums: a SlidingGram after maintain() closed the block that ends both the window `solver`
  /// solved and the window `fit` fits, or other blocks of the same length. The pass must be done
  /// before the next block closes. prior_doubt: how far the prior's center may be off, over the
  /// tolerance of a design. noise_level: variance of the actual noise over the variance that the
  /// tuning assumes.
  template <typename Sums>
  void begin(const Sums& sums, StorySolver& solver, const Fit& fit,
             const std::vector<double>& prior, const std::vector<double>& prior_doubt,
             const NoiseCompensation& noise, double noise_level) {
    block_.assign(static_cast<std::size_t>(fit.blocks), nullptr);
    std::fill(holds_.begin(), holds_.end(), 0);
    for (int b = 0; b < fit.blocks; ++b) {
      block_[static_cast<std::size_t>(b)] = sums.block(b);
      for (int f = 0; f < layout_.floors(); ++f)
        if (sums.holds(b, f)) holds_[static_cast<std::size_t>(f * kBlocks + score_of(b))] = 1;
    }
    begin(sums.shape(), solver, fit, prior, prior_doubt, noise, noise_level);
  }
  /// Returns the number of steps of a pass.
  int steps() const { return 2 * layout_.floors(); }
  bool running() const { return next_step_ < steps(); }
  /// Advances by at most `count` steps. Returns true if that completed the pass.
  bool advance(int count);
  /// Abandons the pass in progress, if any. Results remain.
  void cancel() { next_step_ = steps(); }

  /// Returns the standard errors, internal order, relative to theta0.
  const std::vector<double>& std_error() const { return std_error_; }
  /// Returns the share of the prior in the solution, 0..1 up to rounding.
  const std::vector<double>& prior_share() const { return prior_share_; }
  /// Returns the share of the noise that remains in the equations, 0..1 up to rounding.
  const std::vector<double>& noise_share() const { return noise_share_; }
  /// Returns the diagonal of the inverse of the normal matrix, relative to theta0. Valid from the
  /// advance() that completes a pass to the next begin().
  const std::vector<double>& inverse_diagonal() const { return inverse_diagonal_; }

  /// rows, sums: those of the pass in progress, if any.
  void archive(auto& a, const RowFilter& rows, const auto& sums) {
    a.within(next_step_, 0, steps());
    a(factor_, inverse_, noise_level_, columns_values_, solution_, score_scale_);
    a(prior_, prior_doubt_, inverse_diagonal_, new_error_, new_share_, new_noise_share_);
    a(std_error_, prior_share_, noise_share_);
    noise_.archive(a, rows);
    shape_ = &sums.shape();
    std::int64_t blocks = static_cast<std::int64_t>(block_.size());
    if (a.since(18)) a.within(blocks, kBlocks, kMaxBlocks);
    block_.resize(static_cast<std::size_t>(blocks), nullptr);
    for (const double*& block : block_) {
      std::int64_t number = running() ? sums.number_of(block) : -1;
      a(number);
      block = sums.block_of(number);
    }
    a.each_within(holds_, 0, 1);
    if (running() && !noise_.known()) a.refuse();
  }

 private:
  static constexpr int kMaxBlocks = 1 << 20;
  void begin(const GramShape& shape, StorySolver& solver, const Fit& fit,
             const std::vector<double>& prior, const std::vector<double>& prior_doubt,
             const NoiseCompensation& noise, double noise_level);
  void assemble(int floor);
  void add_block_scores(int floor);
  void add_bias_columns(int floor);
  void finish(int floor);
  /// Returns the score, 0..kBlocks-1, to which a block counts.
  int score_of(int block) const { return block * kBlocks / static_cast<int>(block_.size()); }
  bool has_rows(int floor, int score) const;
  int scores_with_rows(int floor) const;
  double widening(int floor, int position, int scores) const;
  double* columns(int unknown) { return columns_values_.data() + unknown * columns_; }

  FloorLayout layout_;
  int columns_;
  StoryFactor factor_;
  InverseDiagonal inverse_;
  NoiseCompensation noise_;
  double noise_level_ = 0;
  int next_step_;
  const GramShape* shape_ = nullptr;
  std::vector<const double*> block_;    ///< newest first; nullptr: before the start
  std::vector<std::uint8_t> holds_;     ///< floors x kBlocks: the floor has rows in a score
  std::vector<double> columns_values_;  ///< unknowns x (scores, then perturbations)
  PerturbedDesigns perturbed_;
  std::vector<double> solution_, score_scale_, prior_, prior_doubt_, x_, score_, inverse_diagonal_;
  std::vector<double> new_error_, new_share_, new_noise_share_;
  std::vector<double> std_error_, prior_share_, noise_share_;
};

/// Computes the effect of mass errors on the solution of a building with a sensor on every floor.
/// The response of a floor's equations is proportional to its mass. The result is the rms over
/// fixed random errors, each within the masses' tolerance, carried through the normal equations.
/// Not for groups of stories. docs/equations.md, errors of the model.
class MassErrors {
 public:
  static constexpr int kDraws = 20;

  explicit MassErrors(const FloorLayout& layout);

  /// Begins a pass. tolerance: relative standard deviation of a floor's mass. Takes the solver's
  /// factor. sums: those that were factored; they must be kept until the pass is done.
  void begin(StorySolver& solver, const GramShape& shape, const std::vector<double>& sums,
             double tolerance);
  bool running() const { return next_step_ < 2 * layout_.floors(); }
  /// Advances by at most `count` floors. Returns true if that completed the pass.
  bool advance(int count);
  void cancel() { next_step_ = 2 * layout_.floors(); }
  /// Returns the errors of the last completed pass, relative to theta0, internal order.
  const std::vector<double>& error() const { return error_; }

  /// shape, sums: those of the pass in progress, if any.
  void archive(auto& a, const GramShape& shape, const std::vector<double>& sums) {
    a.within(next_step_, 0, 2 * layout_.floors());
    a(factor_, columns_, new_error_);
    a.finite(tolerance_, error_);
    shape_ = &shape;
    sums_ = sums.data();
  }

 private:
  void load(int floor);
  void finish(int floor);
  double* column(int unknown) { return &columns_[static_cast<std::size_t>(unknown) * kDraws]; }

  FloorLayout layout_;
  StoryFactor factor_;
  const GramShape* shape_ = nullptr;
  const double* sums_ = nullptr;
  double tolerance_ = 0;
  int next_step_;
  std::vector<double> columns_;  ///< unknowns x kDraws
  std::vector<double> new_error_, error_;
};

}  // namespace framewatch::estimator
