// SPDX-License-Identifier: MIT
#include "estimator/identify/gram/sliding_gram.h"

#include <algorithm>
#include <cstddef>

#include "estimator/numeric/kernels.h"

namespace framewatch::estimator {
namespace {

constexpr int kSpansPerLength = 5;
constexpr double kMaxEnergy = 1e60;  // of a block, in squares of noise: beyond any motion

}  // namespace

GramShape::GramShape(const FloorLayout& layout) {
  for (int f = 0; f < layout.floors(); ++f) {
    const int front = layout.front(f);
    const int stride = padded(front);
    floor.push_back({size, front, stride});
    for (int i = 0; i < front; ++i) size += static_cast<std::size_t>(stride - packed_row_begin(i));
  }
}

SlidingGram::SlidingGram(const FloorLayout& layout, int blocks, int block_rows,
                         const std::vector<int>& spans)
    : shape_(layout),
      floors_(layout.floors()),
      most_rows_(layout.most_rows()),
      blocks_(blocks),
      block_rows_(block_rows),
      held_blocks_(blocks) {
  for (const int span : spans) {
    held_blocks_ = std::max(held_blocks_, span);
    spans_.push_back({span, std::max(1, span / kSpansPerLength),
                      std::vector<double>(shape_.size, 0.0),
                      std::vector<double>(shape_.size, 0.0)});
  }
  for (std::vector<double>* state : {&current_, &middle_, &next_middle_, &zero_})
    state->assign(shape_.size, 0.0);
  blocks_ring_.assign(shape_.size * static_cast<std::size_t>(held_blocks_), 0.0);
  suffixes_.assign(shape_.size * static_cast<std::size_t>(std::max(block_rows - 1, 0)), 0.0);
  for (int f = 0; f < floors_; ++f) {
    row_offset_.push_back(instant_rows_);
    instant_rows_ += static_cast<std::size_t>(layout.most_rows() * padded(layout.front(f)));
  }
  const auto rows = static_cast<std::size_t>(block_rows);
  const auto floors = static_cast<std::size_t>(floors_);
  stored_rows_.assign(instant_rows_ * rows, 0.0);
  stored_counts_.assign(floors * rows, 0);
  counts_.assign(floors * static_cast<std::size_t>(held_blocks_ + 1), 0);
  instants_.assign(floors, 0);
  middle_instants_.assign(floors, 0);
  reset();
}

void SlidingGram::reset() {
  pushed_ = 0;
  std::fill(current_.begin(), current_.end(), 0.0);
  std::fill(middle_.begin(), middle_.end(), 0.0);
  std::fill(next_middle_.begin(), next_middle_.end(), 0.0);
  for (Span& span : spans_) std::fill(span.next.begin(), span.next.end(), 0.0);
  std::fill(stored_counts_.begin(), stored_counts_.end(), 0);
  std::fill(counts_.begin(), counts_.end(), 0);
  std::fill(middle_instants_.begin(), middle_instants_.end(), 0);
  forward_ = true;
  oldest_ = zero_.data();
}

int SlidingGram::rows() const {
  return static_cast<int>(
      std::min<std::int64_t>(pushed_, static_cast<std::int64_t>(blocks_) * block_rows_));
}

const double* SlidingGram::block(int age) const {
  const std::int64_t newest = closed() - 1;
  if (age > newest) return nullptr;
  return &blocks_ring_[static_cast<std::size_t>((newest - age) % held_blocks_) * shape_.size];
}

bool SlidingGram::sane() const {
  const double* newest = block(0);
  for (const GramShape::Floor& floor : shape_.floor) {
    const double* row = newest + floor.offset;
    for (int i = 0; i < floor.front; ++i) {
      const int begin = packed_row_begin(i);
      if (!(row[i - begin] < kMaxEnergy)) return false;
      row += floor.stride - begin;
    }
  }
  return true;
}

void SlidingGram::count_instants(std::int64_t first, std::int64_t last,
                                 std::vector<int>& instants) {
  std::fill(instants.begin(), instants.end(), 0);
  for (std::int64_t b = std::max<std::int64_t>(first, 0); b <= last; ++b)
    for (std::size_t f = 0; f < instants.size(); ++f) instants[f] += counts(b)[f];
}

WindowParts SlidingGram::window() {
  const std::int64_t block = (pushed_ - 1) / block_rows_;
  const auto into_block = static_cast<int>((pushed_ - 1) % block_rows_) + 1;
  // The oldest block leaves row by row, so its count is reduced in proportion.
  const int* newest = counts(block);
  const int* oldest = block >= blocks_ ? counts(block - blocks_) : nullptr;
  for (std::size_t f = 0; f < instants_.size(); ++f)
    instants_[f] = middle_instants_[f] + newest[f] +
                   (oldest != nullptr ? oldest[f] * (block_rows_ - into_block) / block_rows_ : 0);
  return {&shape_, current_.data(), middle_.data(), oldest_, window_rows(), &instants_};
}

WindowParts SlidingGram::span(int i) {
  const Span& span = spans_[static_cast<std::size_t>(i)];
  const std::int64_t newest = pushed_ / block_rows_ - 1;
  count_instants(newest - span.blocks + 1, newest, instants_);
  return {&shape_,      span.sum.data(),           zero_.data(),
          zero_.data(), span.blocks * block_rows_, &instants_};
}

void SlidingGram::push(const RowFilter& entering) {
  const int j = static_cast<int>(pushed_ % block_rows_) + 1;
  int* count = counts(pushed_ / block_rows_);
  if (j == 1) std::fill(count, count + floors_, 0);
  for (int f = 0; f < floors_; ++f) {
    const GramShape::Floor& shape = shape_.floor[static_cast<std::size_t>(f)];
    double* to = &current_[shape.offset];
    kernels::in_use->add_rows(to, to, entering.rows(f), entering.count(f), shape.front,
                              shape.stride);
    if (entering.count(f) > 0) ++count[f];
  }
  // slot(j) holds what this block needs at row j, then receives what the next block needs at row
  // block_rows - j. So one set of slots is enough, used in alternating directions. In the first
  // block after a reset no rows leave, and the slots are stale.
  oldest_ = j < block_rows_ && pushed_ >= block_rows_ ? suffix(forward_ ? j : block_rows_ - j)
                                                      : zero_.data();
  ++pushed_;
}

bool SlidingGram::maintain(const RowFilter* delayed) {
  const int j = static_cast<int>((pushed_ - 1) % block_rows_) + 1;
  if (j < block_rows_) build_suffix(j);
  if (delayed != nullptr) store_delayed(*delayed, j);
  add_slices(j);
  if (j < block_rows_) return false;
  close_block();
  return true;
}

void SlidingGram::build_suffix(int j) {
  const int slot = forward_ ? j : block_rows_ - j;
  const int previous = forward_ ? j - 1 : block_rows_ - j + 1;
  const double* from = j == 1 ? zero_.data() : suffix(previous);
  double* to = suffix(slot);
  const auto stored = static_cast<std::size_t>(forward_ ? block_rows_ - j : j - 1);
  const double* rows = &stored_rows_[stored * instant_rows_];
  const int* count = &stored_counts_[stored * static_cast<std::size_t>(floors_)];
  for (int f = 0; f < floors_; ++f) {
    const GramShape::Floor& shape = shape_.floor[static_cast<std::size_t>(f)];
    kernels::in_use->add_rows(from + shape.offset, to + shape.offset,
                              rows + row_offset_[static_cast<std::size_t>(f)], count[f],
                              shape.front, shape.stride);
  }
}

void SlidingGram::store_delayed(const RowFilter& delayed, int j) {
  const auto stored = static_cast<std::size_t>(forward_ ? block_rows_ - j : j - 1);
  std::copy(delayed.data(), delayed.data() + instant_rows_,
            stored_rows_.begin() + static_cast<std::ptrdiff_t>(stored * instant_rows_));
  for (int f = 0; f < floors_; ++f)
    stored_counts_[stored * static_cast<std::size_t>(floors_) + static_cast<std::size_t>(f)] =
        delayed.count(f);
}

void SlidingGram::add_slices(int j) {
  const std::int64_t block = (pushed_ - 1) / block_rows_;
  add_slice(block - (blocks_ - 2), block, j, block_rows_, next_middle_);
  for (Span& span : spans_) {
    // Blocks that close meanwhile are added when they close.
    const auto since = static_cast<int>(block % span.every);
    const std::int64_t start = block - since;
    add_slice(start - (span.blocks - span.every), start, since * block_rows_ + j,
              span.every * block_rows_, span.next);
  }
}

void SlidingGram::add_slice(std::int64_t first, std::int64_t last, int part, int parts,
                            std::vector<double>& sum) {
  const std::int64_t oldest = std::max<std::int64_t>(first, 0);
  const auto total = static_cast<std::size_t>(last - oldest) * shape_.size;
  std::size_t at = total * static_cast<std::size_t>(part - 1) / static_cast<std::size_t>(parts);
  const std::size_t end = total * static_cast<std::size_t>(part) / static_cast<std::size_t>(parts);
  while (at < end) {
    const std::size_t within = at % shape_.size;
    const std::size_t length = std::min(shape_.size - within, end - at);
    const auto ring = static_cast<std::size_t>(
        (oldest + static_cast<std::int64_t>(at / shape_.size)) % held_blocks_);
    kernels::in_use->add(&sum[within], &blocks_ring_[ring * shape_.size + within],
                         static_cast<long>(length));
    at += length;
  }
}

void SlidingGram::close_block() {
  const auto ring = static_cast<std::size_t>((pushed_ / block_rows_ - 1) % held_blocks_);
  kernels::in_use->add(next_middle_.data(), current_.data(), static_cast<long>(shape_.size));
  std::copy(current_.begin(), current_.end(),
            blocks_ring_.begin() + static_cast<std::ptrdiff_t>(ring * shape_.size));
  for (Span& span : spans_) {
    kernels::in_use->add(span.next.data(), current_.data(), static_cast<long>(shape_.size));
    if (pushed_ / block_rows_ % span.every != 0) continue;
    span.sum.swap(span.next);
    std::fill(span.next.begin(), span.next.end(), 0.0);
  }
  const std::int64_t closed = pushed_ / block_rows_ - 1;
  count_instants(closed - (blocks_ - 2), closed, middle_instants_);
  middle_.swap(next_middle_);
  std::fill(next_middle_.begin(), next_middle_.end(), 0.0);
  std::fill(current_.begin(), current_.end(), 0.0);
  forward_ = !forward_;
}

}  // namespace framewatch::estimator
