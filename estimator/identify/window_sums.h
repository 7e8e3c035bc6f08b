#pragma once

#include <cstdint>
#include <vector>

#include "estimator/identify/floor_layout.h"
#include "estimator/identify/row_chain.h"

namespace framewatch {

/// Where the packed normal equations of each floor lie in one flat state.
struct SumsShape {
  explicit SumsShape(const FloorLayout& layout);
  struct Floor {
    std::size_t offset;
    int front;
    int stride;
  };
  std::vector<Floor> floor;
  std::size_t size = 0;
};

/// Sum over the window of (row)(row)^T, floor by floor, kept without a single subtraction: whole
/// blocks, the block being filled, and ready-made sums of what remains of the oldest block.
/// Rounding errors of a strong motion leave with its rows. docs/equations.md, block sums.
///
/// In block b, row j (1-based): window = suffix of block b-blocks (rows j+1..) + blocks between +
/// rows 1..j of block b. The suffixes are built backwards, one row per instant, during block b-1,
/// from rows a second chain produced during block b-2.
class WindowSums {
 public:
  WindowSums(const FloorLayout& layout, int blocks, int block_rows);

  void reset();
  /// Instants the second chain lags behind the first.
  int lag() const { return (blocks_ - 2) * block_rows_; }

  /// Adds one instant; the window's sum is then newest() + middle() + oldest().
  void push(const RowChain& entering);
  /// Prepares the next instant, once the sum has been used. delayed: the second chain at the
  /// instant lag() before the one pushed, or null while there is none. True when a block closed.
  bool maintain(const RowChain* delayed);

  bool full() const { return pushed_ >= static_cast<std::int64_t>(blocks_) * block_rows_; }
  /// After push(): maintain() will close a block.
  bool block_full() const { return pushed_ % block_rows_ == 0; }
  int window_rows() const { return blocks_ * block_rows_; }
  /// Instants in the window so far.
  int rows() const;

  const SumsShape& shape() const { return shape_; }
  /// The three parts whose sum is the window's; valid from push() to maintain().
  const double* newest() const { return current_.data(); }
  const double* middle() const { return middle_.data(); }
  const double* oldest() const { return oldest_; }
  int blocks() const { return blocks_; }
  /// Completed block, age 0 = the newest; valid after maintain().
  const double* block(int age) const;
  /// Instants, to a block, in which a floor had rows in the window.
  int floor_instants(int floor) const;

 private:
  double* suffix(int slot) { return &suffixes_[static_cast<std::size_t>(slot - 1) * shape_.size]; }
  void build_suffix(int j);
  void store_delayed(const RowChain& delayed, int j);
  void add_slice(int j);
  void close_block();
  int* counts(std::int64_t block) {
    return &counts_[static_cast<std::size_t>(block % blocks_ * floors_)];
  }

  SumsShape shape_;
  int floors_;
  int blocks_, block_rows_;
  std::int64_t pushed_ = 0;
  std::vector<double> current_, middle_, next_middle_, zero_;
  std::vector<double> blocks_ring_;      ///< blocks x state
  std::vector<double> suffixes_;         ///< (block_rows - 1) x state
  std::vector<double> stored_rows_;      ///< block_rows x rows of one instant
  std::vector<int> stored_counts_;       ///< block_rows x floors
  std::vector<std::size_t> row_offset_;  ///< of a floor in one instant's rows
  std::size_t instant_rows_ = 0;
  bool forward_ = true;  ///< direction in which this block uses the slots
  const double* oldest_ = nullptr;
  std::vector<int> counts_;  ///< blocks x floors, the current block's among them
};

}  // namespace framewatch
