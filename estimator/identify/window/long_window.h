// SPDX-License-Identifier: MIT
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

/// The normal equations of a long window, for instance an hour, in BatchMeans::kBlocks pieces of
/// whole blocks. It identifies parameters whose elements move too weakly for an ordinary window. A
/// length has five windows. docs/equations.md (47).
///
/// Two limits keep strong blocks from dominating. A block whose response has more than kMaxOfUsual
/// times the usual energy is scaled down to that, because a single strong motion has no spread. A
/// block whose residual under the last solution has more than kMaxOfUsualMisfit times the usual
/// energy, as with a sensor's spike, is scaled down by the square of the excess. The equations hold
/// with any weights.
///
/// Nearly all of the expected sensor noise is subtracted, because its sum over an hour is hardly
/// random.
class LongWindow {
 public:
  static constexpr double kMaxOfUsual = 10, kMaxOfUsualMisfit = 4, kCompensatedShare = 0.98;

  /// Limits the blocks as described above, or takes them with their energy. options.long_window_s
  /// must cover at least BatchMeans::kBlocks blocks. window: WindowEstimate::window of its
  /// estimates. Without configured noise, the gate is that of ordinary windows: measured noise is
  /// too inexact to be subtracted from a motion that is as weak.
  enum class Blocks { limited, by_energy };
  LongWindow(const Structure& structure, const FloorLayout& layout, const ParameterTable& table,
             const EstimatorOptions& options, int block_rows, int window, bool noise_configured,
             Blocks blocks = Blocks::limited);

  int rows() const { return kPieces * piece_blocks_ * block_rows_; }
  /// Discards everything so far, because the tuning has changed and old sums belong to other rows.
  void retuned();
  /// Keeps everything so far after a change of the tuning, as if it belonged to the new one.
  /// Unknowns become relative to theta0 times `factor`, internal order.
  void rescale(const std::vector<double>& factor);
  /// Discards the pieces so far.
  void begin_anew();
  /// Takes the block that closed at `time`, the end of its last instant. known: flags of places
  /// with a working sensor. Blocks with other places than the rest are left out. When more of them
  /// come in a row than a piece holds, the window starts anew with them.
  void block_closed(SlidingGram& sums, const std::vector<std::uint8_t>& known, Time time);

  struct Context {
    TunedRegression* regression;
    const std::vector<std::uint8_t>* known;
    WindowSolution::Trust trust;
    bool tuned;
  };
  /// Does one instant's share of the work. Returns the estimate that it completed, or nullptr.
  const WindowEstimate* advance(const Context& context);
  /// Returns the solution of the newest estimate.
  const WindowSolution& solution() const { return solution_; }

  // Gives completed pieces in the way SlidingGram gives blocks.
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

  void archive(auto& a, TunedRegression& regression) {
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
  /// Returns the energy of the response, or of its residual under the last solution.
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
  std::vector<double> ring_instants_, instants_;  ///< by floor: of every piece; of this one
  std::vector<double> ring_rows_;                 ///< weighted rows of every piece
  std::vector<Time> begins_;                      ///< start of every piece
  Time end_{}, since_{};  ///< end of the newest piece; start of the current one
  std::vector<int> whole_instants_;
  double usual_ = 0;         ///< energy of a typical block, near the median; 0: unknown
  double usual_misfit_ = 0;  ///< the same for its residual
  std::vector<double> fit_;  ///< the last solution
  std::vector<double> x_;    ///< buffer of one call
  double rows_ = 0;          ///< weighted rows of the current piece
  int blocks_ = 0;           ///< blocks of the current piece
  std::int64_t pieces_ = 0;
  std::vector<std::uint8_t> known_;  ///< places of all blocks so far
  int left_out_ = 0;                 ///< blocks left out in a row
  Work work_ = Work::none;
  std::size_t added_ = 0;  ///< doubles added so far in Work::adding
};

/// Holds the bending stiffness of a building in groups (krx, kry). It belongs to the whole
/// building, changes slowly, and a window of seconds hardly shows it. It is identified in
/// consecutive windows of kWindow_s, each weighted by its error. The sliding windows hold it at the
/// value that these windows and the design give together. docs/equations.md, groups of stories.
class HeldBending {
 public:
  static constexpr double kWindow_s = 10;
  /// Least relative error, and relative drift from one such window to the next.
  static constexpr double kMin = 0.02, kDrift = 0.01;

  /// design: theta order, SI.
  HeldBending(const Structure& structure, const FloorLayout& layout, const ParameterTable& table,
              const EstimatorOptions& options, int block_rows, bool noise_configured,
              const Eigen::VectorXd& design);

  /// Discards the current window, because other samples follow.
  void restart() { window_.retuned(); }
  /// Applies LongWindow::rescale(). The window survives retuning, because strong motion does not
  /// last long enough otherwise.
  void retuned(const std::vector<double>& factor) { window_.rescale(factor); }
  void block_closed(SlidingGram& sums, const std::vector<std::uint8_t>& known, Time time) {
    window_.block_closed(sums, known, time);
  }
  /// Does one instant's share of the work. Returns true if the held value has changed.
  bool advance(const LongWindow::Context& context);

  struct Held {
    int parameter;
    int unknown;
    double value;      ///< N*m/rad
    double std_error;  ///< relative
  };
  const std::vector<Held>& held() const { return held_; }

  void archive(auto& a, TunedRegression& regression) {
    window_.archive(a, regression);
    for (Held& h : held_) {
      a.within(h.value, std::numeric_limits<double>::min(), a.kMax);
      a.within(h.std_error, kMin, 1);
    }
  }

 private:
  /// Returns the largest relative distance of the stiffnesses from the point where the equations
  /// were linearized.
  double detuning(const WindowSolution& solution) const;

  LongWindow window_;
  std::vector<int> stiffnesses_;  ///< the unknowns that are stiffnesses
  std::vector<Held> held_;
};

}  // namespace framewatch::estimator
