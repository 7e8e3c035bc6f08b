#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "estimator/identify/estimate/estimate.h"
#include "estimator/identify/window/tuned_regression.h"
#include "estimator/identify/window/window_solution.h"
#include "estimator/setup/pipeline_config.h"

namespace framewatch::estimator {

/// The normal equations of a long window, an hour for instance, in BatchMeans::kBlocks pieces of
/// whole blocks: it identifies what moves too weakly for an ordinary window. Five windows per
/// length. docs/equations.md (47).
///
/// A block whose response has more than kMaxOfUsual times the usual energy is scaled down to that,
/// so that one strong motion, a single piece without a spread, does not dominate the hour. A block
/// whose residual under the last solution has more than kMaxOfUsualMisfit times the usual energy,
/// a sensor's spike for instance, is scaled down by the square of the excess. The equations hold
/// with any weights. Nearly all of the expected sensor noise is subtracted, because over an hour
/// its sum is hardly random any more.
class LongWindow {
 public:
  static constexpr double kMaxOfUsual = 10, kMaxOfUsualMisfit = 4, kCompensatedShare = 0.98;

  /// options.long_window_s: at least that of BatchMeans::kBlocks blocks. window: of its estimates.
  /// Without configured noise the gate is that of ordinary windows: measured noise is too inexact
  /// to be subtracted from a motion as weak as itself.
  /// Blocks count alike, see above, or as they are.
  enum class Blocks { limited, by_energy };
  LongWindow(const Structure& structure, const FloorLayout& layout, const ParameterTable& table,
             const EstimatorOptions& options, int block_rows, int window, bool noise_configured,
             Blocks blocks = Blocks::limited);

  int rows() const { return kPieces * piece_blocks_ * block_rows_; }
  /// The tuning has changed: everything so far is of other rows and is discarded.
  void retuned();
  /// The tuning has changed, and everything so far is kept as if of the new one: unknowns become
  /// relative to theta0 times `factor`, internal order.
  void rescale(const std::vector<double>& factor);
  /// The pieces so far are not used again.
  void begin_anew();
  /// A block has closed at `time`, the end of its last instant. known: places with a working
  /// sensor. Blocks with other places than the rest are left out; when more of them than a piece
  /// holds come in a row, the window begins anew with them.
  void block_closed(SlidingGram& sums, const std::vector<std::uint8_t>& known, Time time);

  struct Context {
    TunedRegression* regression;
    const std::vector<std::uint8_t>* known;
    WindowSolution::Trust trust;
    bool tuned;
  };
  /// One instant's share of the work; the estimate that it completed, or null.
  const WindowEstimate* advance(const Context& context);
  /// Of the newest estimate.
  const WindowSolution& solution() const { return solution_; }

  // Completed pieces as SlidingGram has blocks.
  const GramShape& shape() const { return shape_; }
  const double* block(int age) const;
  bool holds(int age, int floor) const {
    return ring_instants_[static_cast<std::size_t>((pieces_ - 1 - age) % kPieces * floors_ +
                                                   floor)] > 0;
  }
  std::int64_t number_of(const double* block) const {
    return block == nullptr ? -1 : (block - ring_.data()) / std::ptrdiff_t(shape_.size);
  }
  const double* block_of(std::int64_t number) const {
    return number < 0 || number >= kPieces ? nullptr
                                           : &ring_[static_cast<std::size_t>(number) * shape_.size];
  }

  template <typename Archive>
  void archive(Archive& a, TunedRegression& regression) {
    a.finite(ring_, current_, sum_, ring_instants_, instants_, usual_, usual_misfit_, fit_, rows_,
             ring_rows_);
    a(begins_, end_, since_);
    a.within(blocks_, 0, piece_blocks_ - 1);
    a.within(pieces_, 0, a.kMaxCount);
    a.within(work_, 0, static_cast<double>(Work::errors));
    a.within(added_, 0, static_cast<double>(ring_.size()));
    a.within(left_out_, 0, a.kMaxCount);
    a.any_size(known_);
    solution_.archive(a, regression.rows(), *this);
    a(estimate_);
  }

 private:
  static constexpr int kPieces = BatchMeans::kBlocks;
  enum class Work { none, adding, solving, errors };
  bool fits(const std::vector<std::uint8_t>& known);
  double weight(const double* block);
  void rescale(double* block, const std::vector<double>& factor);
  /// Of the response, or of its residual under the last solution.
  double energy(const double* block, bool residual);
  void close_piece();
  void add_some();
  void solve(const Context& context);
  const WindowEstimate& give(const Context& context);

  GramShape shape_;
  Blocks which_;
  int floors_;
  std::size_t own_;
  int block_rows_, piece_blocks_;
  double rate_hz_;
  WindowSolution solution_;
  WindowEstimate estimate_;
  std::vector<double> ring_, current_, sum_, zero_;
  std::vector<double> ring_instants_, instants_;  ///< floors of every piece; of the current one
  std::vector<double> ring_rows_;                 ///< of every piece, weighted
  std::vector<Time> begins_;                      ///< of every piece
  Time end_{}, since_{};                          ///< of the newest piece; of the current one
  std::vector<int> whole_instants_;
  double usual_ = 0;         ///< energy of a block, about the median; 0: none seen
  double usual_misfit_ = 0;  ///< likewise, of its residual
  std::vector<double> fit_;  ///< the last solution
  std::vector<double> x_;    ///< of one call
  double rows_ = 0;          ///< of the current piece, weighted
  int blocks_ = 0;           ///< of the current piece
  std::int64_t pieces_ = 0;
  std::vector<std::uint8_t> known_;  ///< of all blocks so far
  int left_out_ = 0;                 ///< blocks in a row that were left out
  Work work_ = Work::none;
  std::size_t added_ = 0;  ///< doubles, in Work::adding
};

/// The bending stiffness of a building of groups (krx, kry): a property of the whole building that
/// moves slowly and that a window of seconds hardly shows. Identified free over windows of
/// kWindow_s, one after the other, each weighted by its error, and held in the sliding windows at
/// what they and the design say together. docs/equations.md, groups of stories.
class HeldBending {
 public:
  static constexpr double kWindow_s = 10;
  /// Relative: of the least error, and of what it may move from one such window to the next.
  static constexpr double kMin = 0.02, kDrift = 0.01;

  /// design: theta order, SI.
  HeldBending(const Structure& structure, const FloorLayout& layout, const ParameterTable& table,
              const EstimatorOptions& options, int block_rows, bool noise_configured,
              const Eigen::VectorXd& design);

  /// What was gathered is of other samples.
  void restart() { window_.retuned(); }
  /// LongWindow::rescale(): gathered over retunings, or strong motion would never last long enough.
  void retuned(const std::vector<double>& factor) { window_.rescale(factor); }
  void block_closed(SlidingGram& sums, const std::vector<std::uint8_t>& known, Time time) {
    window_.block_closed(sums, known, time);
  }
  /// One instant's share of the work; true when what is held has changed.
  bool advance(const LongWindow::Context& context);

  struct Held {
    int parameter;
    int unknown;
    double value;      ///< N*m/rad
    double std_error;  ///< relative
  };
  const std::vector<Held>& held() const { return held_; }

  template <typename Archive>
  void archive(Archive& a, TunedRegression& regression) {
    window_.archive(a, regression);
    for (Held& h : held_) {
      a.within(h.value, std::numeric_limits<double>::min(), a.kMax);
      a.within(h.std_error, kMin, 1);
    }
  }

 private:
  /// How far, relative, the stiffnesses are from where the equations were made linear.
  double detuning(const WindowSolution& solution) const;

  LongWindow window_;
  std::vector<int> stiffnesses_;  ///< unknowns
  std::vector<Held> held_;
};

}  // namespace framewatch::estimator
