// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "estimator/identify/elements/floor_layout.h"
#include "estimator/identify/regressors/row_tuning.h"

namespace framewatch::estimator {

/// The place of each floor's packed Gram matrix in one flat array.
struct GramShape {
  explicit GramShape(const FloorLayout& layout);
  struct Floor {
    std::size_t offset;
    int front;
    int stride;
  };
  std::vector<Floor> floor;
  std::size_t size = 0;
};

/// The sum of H^T H of a window in three parts, which must be added.
struct WindowParts {
  const GramShape* shape;
  const double* newest;
  const double* middle;
  const double* oldest;
  int rows;                          ///< instants
  const std::vector<int>* instants;  ///< by floor: instants in which it had rows
};

/// The Gram matrix of the sliding window, floor by floor: the sum of H^T H over the rows [h, z] of
/// the regression. It is updated recursively without any subtraction, from sums of whole blocks, of
/// the block being filled, and of what remains of the oldest block. So the rounding errors of a
/// strong motion leave with its rows. docs/equations.md, block sums.
///
/// In block b, after row j (1-based), the window is the suffix of block b-blocks (rows j+1..), the
/// blocks between, and rows 1..j of block b. The suffixes are built backwards during block b-1, one
/// row per instant, from rows that a second, delayed regressor filter formed during block b-2.
///
/// Spans are further windows of whole blocks, summed from the same blocks. Their windows end a
/// fifth of their length apart, and at most once per block.
class SlidingGram {
 public:
  /// spans: their lengths in blocks.
  SlidingGram(const FloorLayout& layout, int blocks, int block_rows,
              const std::vector<int>& spans = {});

  void reset();
  /// Returns the number of instants by which the delayed regressor filter lags.
  int lag() const { return (blocks_ - 2) * block_rows_; }

  /// Adds one instant. window() then returns the sum of the window that ends with it.
  void push(const RowFilter& entering);
  /// Prepares the next instant, after the sum has been used. delayed: the delayed filter at the
  /// instant lag() before the pushed one, or nullptr before the first such instant. Returns true if
  /// a block closed.
  bool maintain(const RowFilter* delayed);

  bool full() const { return pushed_ >= static_cast<std::int64_t>(blocks_) * block_rows_; }
  /// Returns true after push() if maintain() will close a block.
  bool block_full() const { return pushed_ % block_rows_ == 0; }
  int window_rows() const { return blocks_ * block_rows_; }
  /// Returns the number of instants in the window so far.
  int rows() const;

  const GramShape& shape() const { return shape_; }
  /// Returns the sum of the window. Valid from push() to maintain().
  WindowParts window();
  /// Returns true if the block that maintain() closed is the last one of a span.
  bool span_full(int i) const {
    const Span& span = spans_[static_cast<std::size_t>(i)];
    const std::int64_t closed = pushed_ / block_rows_;
    return closed >= span.blocks && closed % span.every == 0;
  }
  /// Returns the sum of span i. Valid from the maintain() that closed its last block to the one
  /// that closes the next.
  WindowParts span(int i);
  /// Returns the number of instants in the longest window.
  int longest_rows() const { return held_blocks_ * block_rows_; }
  int spans() const { return static_cast<int>(spans_.size()); }
  int blocks() const { return blocks_; }
  int block_rows() const { return block_rows_; }
  /// Returns the number of blocks completed since the start.
  std::int64_t closed() const { return pushed_ / block_rows_; }
  /// Returns a completed block, age 0 is the newest, or nullptr before the start. Call it after
  /// maintain().
  const double* block(int age) const;
  /// Returns true if a floor has rows in that block.
  bool holds(int age, int floor) const {
    const std::int64_t block = closed() - 1 - age;
    return block >= 0 &&
           counts_[static_cast<std::size_t>(block % (held_blocks_ + 1) * floors_ + floor)] > 0;
  }

  /// Returns true if the newest completed block can be sums of squares of rows. Call it after
  /// maintain().
  bool sane() const;
  /// Returns by floor the instants of the newest completed block in which it had rows.
  const int* newest_instants() { return counts(pushed_ / block_rows_ - 1); }

  /// Convert a completed block to a number, -1 for nullptr, and back.
  std::int64_t number_of(const double* block) const {
    return block == nullptr ? -1 : (block - blocks_ring_.data()) / std::ptrdiff_t(shape_.size);
  }
  const double* block_of(std::int64_t number) const {
    return number < 0 || number >= held_blocks_
               ? nullptr
               : &blocks_ring_[static_cast<std::size_t>(number) * shape_.size];
  }
  void archive(auto& a) {
    a.within(pushed_, 0, a.kMaxCount);
    a.finite(current_, middle_, next_middle_, blocks_ring_, suffixes_, stored_rows_);
    a(spans_, forward_);
    a.each_within(stored_counts_, 0, most_rows_);
    a.each_within(middle_instants_, 0, a.kMaxCount);
    a.each_within(counts_, 0, block_rows_);
    oldest_ = zero_.data();
  }

 private:
  double* suffix(int slot) { return &suffixes_[static_cast<std::size_t>(slot - 1) * shape_.size]; }
  void build_suffix(int j);
  void store_delayed(const RowFilter& delayed, int j);
  void count_instants(std::int64_t first, std::int64_t last, std::vector<int>& instants);
  /// Adds one of `parts` slices of the completed blocks first..last - 1 to a sum.
  void add_slice(std::int64_t first, std::int64_t last, int part, int parts,
                 std::vector<double>& sum);
  void add_slices(int j);
  void close_block();
  int* counts(std::int64_t block) {
    return &counts_[static_cast<std::size_t>(block % (held_blocks_ + 1) * floors_)];
  }

  GramShape shape_;
  int floors_, most_rows_;
  int blocks_, block_rows_;
  int held_blocks_;  ///< blocks in the longest window
  std::int64_t pushed_ = 0;
  std::vector<double> current_, middle_, next_middle_, zero_;
  struct Span {
    int blocks, every;
    std::vector<double> next, sum;

    void archive(auto& a) { a.finite(next, sum); }
  };
  std::vector<Span> spans_;
  std::vector<double> blocks_ring_;      ///< held blocks x state
  std::vector<double> suffixes_;         ///< (block_rows - 1) x state
  std::vector<double> stored_rows_;      ///< block_rows x rows of one instant
  std::vector<int> stored_counts_;       ///< block_rows x floors
  std::vector<std::size_t> row_offset_;  ///< where a floor begins in the rows of one instant
  std::size_t instant_rows_ = 0;
  bool forward_ = true;  ///< direction in which this block uses the slots
  const double* oldest_ = nullptr;
  std::vector<int> instants_;
  std::vector<int> middle_instants_;  ///< instants of the main window's completed blocks
  std::vector<int> counts_;           ///< (held blocks + 1) x floors, including the current block
};

}  // namespace framewatch::estimator
