#pragma once

#include <cstdint>
#include <vector>

#include "estimator/identify/elements/floor_layout.h"
#include "estimator/identify/elements/guessed_design.h"
#include "estimator/identify/gram/sliding_gram.h"
#include "estimator/identify/solve/noise_compensation.h"
#include "estimator/identify/solve/story_solver.h"

namespace framewatch::estimator {

/// Standard deviation of every relative unknown: spread, by batch means (the scores of the window's
/// blocks, nearly independent although the residuals inside a block are not, carried through the
/// factored normal equations), and bias: how far prior and noise can move the solution toward a
/// design that is wrong by its tolerance. docs/equations.md, batch means.
///
/// A pass begins when a block closes and takes steps(), spread over the instants of the next block
/// by their count, so that no instant is late. Results are those of the last completed pass. The
/// scores are those of the newest kBlocks blocks about a solution that fits them, whatever the
/// window's length: a short window has too few blocks, so it takes these, scaled to its own
/// information. While fewer blocks have rows, the spread is taken from those, as Student's
/// distribution widens it, with as many degrees of freedom as there are blocks that count: of a
/// motion that has just begun the last ones carry nearly all information. From fewer than kFewest
/// nothing is known, and the error is infinite.
class BatchMeans {
 public:
  static constexpr int kBlocks = 20, kFewest = 4;

  /// compensation: share of the noise, see NoiseCompensation.
  explicit BatchMeans(const FloorLayout& layout, double compensation = kCompensatedShare);

  /// The window of kBlocks blocks and the solution that fits it.
  struct Fit {
    const std::vector<double>* solution;
    const std::vector<double>* information;
  };
  /// sums: SlidingGram, after maintain() closed the block that ends the window `solver` solved and
  /// `fit` fits, and before the next one closes: the pass must be done by then; or other blocks
  /// that last as long. Takes the solver's factor; its solution stays. prior_doubt: how far the
  /// prior's centre may be off, over the tolerance of a design. noise_level: variance of the
  /// noise that is there, divided by what the tuning assumes.
  template <typename Sums>
  void begin(const Sums& sums, StorySolver& solver, const Fit& fit,
             const std::vector<double>& prior, const std::vector<double>& prior_doubt,
             const NoiseCompensation& noise, double noise_level) {
    for (int b = 0; b < kBlocks; ++b) {
      block_[static_cast<std::size_t>(b)] = sums.block(b);
      for (int f = 0; f < layout_.floors(); ++f)
        holds_[static_cast<std::size_t>(f * kBlocks + b)] = sums.holds(b, f) ? 1 : 0;
    }
    begin(sums.shape(), solver, fit, prior, prior_doubt, noise, noise_level);
  }
  /// Of a whole pass.
  int steps() const { return 2 * layout_.floors(); }
  bool running() const { return next_step_ < steps(); }
  /// Goes on by at most `count` steps; true when that completed the pass.
  bool advance(int count);
  /// Abandons the pass under way, if any; results stay.
  void cancel() { next_step_ = steps(); }

  /// From now on the unknown is relative to another theta0: times `factor`.
  void rescale(int unknown, double factor) {
    std_error_[static_cast<std::size_t>(unknown)] *= factor;
  }
  /// Internal order, relative to theta0.
  const std::vector<double>& std_error() const { return std_error_; }
  /// Share of the prior in the solution, 0..1 and rounding.
  const std::vector<double>& prior_share() const { return prior_share_; }
  /// Share of the noise that remains in the equations, 0..1 and rounding.
  const std::vector<double>& noise_share() const { return noise_share_; }
  /// Diagonal of the inverse of the normal matrix, relative to theta0; valid when advance() has
  /// completed a pass, until the next one begins.
  const std::vector<double>& inverse_diagonal() const { return inverse_diagonal_; }

  /// rows, sums: those of the pass under way, if any.
  template <typename Archive, typename Sums>
  void archive(Archive& a, const RowFilter& rows, const Sums& sums) {
    a.within(next_step_, 0, steps());
    a(factor_, inverse_, noise_level_, columns_values_, solution_, score_scale_);
    a(prior_, prior_doubt_, inverse_diagonal_, new_error_, new_share_, new_noise_share_);
    a(std_error_, prior_share_, noise_share_);
    noise_.archive(a, rows);
    shape_ = &sums.shape();
    for (const double*& block : block_) {
      std::int64_t number = running() ? sums.number_of(block) : -1;
      a(number);
      block = sums.block_of(number);
    }
    a.each_within(holds_, 0, 1);
    if (running() && !noise_.known()) a.refuse();
  }

 private:
  void begin(const GramShape& shape, StorySolver& solver, const Fit& fit,
             const std::vector<double>& prior, const std::vector<double>& prior_doubt,
             const NoiseCompensation& noise, double noise_level);
  void assemble(int floor);
  void add_block_scores(int floor);
  void add_bias_columns(int floor);
  void finish(int floor);
  bool has_rows(int floor, int block) const;
  int blocks_with_rows(int floor) const;
  double widening(int floor, int position, int blocks) const;
  double* columns(int unknown) { return columns_values_.data() + unknown * columns_; }

  FloorLayout layout_;
  int columns_;
  StoryFactor factor_;
  InverseDiagonal inverse_;
  NoiseCompensation noise_;
  double noise_level_ = 0;
  int next_step_;
  const GramShape* shape_ = nullptr;
  std::vector<const double*> block_;    ///< null: before the start
  std::vector<std::uint8_t> holds_;     ///< floors x blocks: the floor has rows in it
  std::vector<double> columns_values_;  ///< unknowns x (blocks, then perturbations)
  PerturbedDesigns perturbed_;
  std::vector<double> solution_, score_scale_, prior_, prior_doubt_, x_, score_, inverse_diagonal_;
  std::vector<double> new_error_, new_share_, new_noise_share_;
  std::vector<double> std_error_, prior_share_, noise_share_;
};

/// What floors whose masses are off by their tolerance make of the solution of a building with a
/// sensor on every floor: the response of a floor's equations is proportional to its mass. The rms
/// over fixed random errors, carried through the normal equations. Not of groups of stories.
/// docs/equations.md, errors of the model.
class MassErrors {
 public:
  static constexpr int kDraws = 20;

  explicit MassErrors(const FloorLayout& layout);

  /// tolerance: relative standard deviation of a floor's mass. Takes the solver's factor; sums:
  /// those it was factored from, to be kept until the pass is done.
  void begin(StorySolver& solver, const GramShape& shape, const std::vector<double>& sums,
             double tolerance);
  bool running() const { return next_step_ < 2 * layout_.floors(); }
  /// Goes on by at most `count` floors; true when that completed the pass.
  bool advance(int count);
  void cancel() { next_step_ = 2 * layout_.floors(); }
  /// Relative to theta0, internal order, of the last completed pass.
  const std::vector<double>& error() const { return error_; }

  /// shape, sums: those of the pass under way, if any.
  template <typename Archive>
  void archive(Archive& a, const GramShape& shape, const std::vector<double>& sums) {
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
