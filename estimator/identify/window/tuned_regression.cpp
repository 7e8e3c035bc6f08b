// SPDX-License-Identifier: MIT
#include "estimator/identify/window/tuned_regression.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/identify/groups/group_tuning.h"
#include "estimator/identify/solve/uncertainty.h"

namespace framewatch::estimator {

MotionRing::MotionRing(const MotionSource& source, int capacity)
    : sets_(static_cast<std::size_t>(capacity), source.make_set()) {}

TunedRegression::TunedRegression(std::unique_ptr<RowTuning> tuning, const FloorLayout& layout,
                                 int blocks, int block_rows, const std::vector<int>& spans)
    : tuning_(std::move(tuning)),
      layout_(layout),
      entering_(tuning_->make_filter(tuning_->start_rows())),
      delayed_(tuning_->make_filter(tuning_->start_rows())),
      sums_(layout_, blocks, block_rows, spans) {}

void TunedRegression::start(std::int64_t instant) {
  next_ = delayed_next_ = instant;
  counting_ = resting_ = false;
  const int start = tuning_->start_rows();
  entering_->reset(start);
  delayed_->reset(start);
  sums_.reset();
}

void TunedRegression::advance(const MotionRing& ring) {
  entering_->push(ring.at(next_++));
  for (int floor = 0; floor < layout_.floors() && !counting_; ++floor)
    counting_ = entering_->forms(floor);
  if (!counting_) {
    counted_from_ = next_;
    return;
  }
  sums_.push(*entering_);
}

bool TunedRegression::finish(const MotionRing& ring) {
  const std::int64_t delayed_instant = next_ - 1 - sums_.lag();
  bool delayed_counts = false;
  if (delayed_instant >= delayed_next_) {
    delayed_->push(ring.at(delayed_next_++));
    delayed_counts = delayed_next_ > counted_from_;
  }
  return counting_ && sums_.maintain(delayed_counts ? delayed_.get() : nullptr);
}

namespace {

constexpr int kFewestBlocks = 4;  // fewest blocks of another window

}  // namespace

DerivativeTriple triple_of(const EstimatorOptions& o, bool grouped, double advance) {
  if (grouped) return held_triple(o.rate_hz, advance);
  return o.variant == Variant::paper ? trapezoid_triple(o.rate_hz)
                                     : matched_triple(o.rate_hz, advance);
}

std::vector<DerivativeTriple> triples_of(const EstimatorOptions& o, bool grouped,
                                         const std::vector<SensorAxis>& axes) {
  std::vector<DerivativeTriple> triples;
  for (const SensorAxis& axis : axes) {
    const double samples = axis.delay * o.rate_hz;
    triples.push_back(triple_of(o, grouped, samples - std::round(samples)));
  }
  return triples;
}

SensorClock::duration duration_of(double rows, double rate_hz) {
  return SensorClock::duration(std::llround(rows * 1e6 / rate_hz));
}

int rows_of(double seconds, double rate) {
  return std::max(1, static_cast<int>(std::lround(seconds * rate)));
}

std::vector<int> blocks_of(const std::vector<double>& windows_s, double rate_hz, int block_rows) {
  std::vector<int> blocks;
  for (const double s : windows_s)
    blocks.push_back(
        std::max(kFewestBlocks, static_cast<int>(std::lround(s * rate_hz / block_rows))));
  return blocks;
}

int kept_beside(const EstimatorOptions& o, bool grouped) {
  const double slowest_s = grouped
                               ? GroupTuning::kLongestSettle_s
                               : 3 / (std::min(o.filter_damping, 0.7) * 2 * M_PI * o.high_pass_hz);
  return rows_of(std::max(o.settle_s, slowest_s), o.rate_hz) + 1;
}

int longest_window(int block_rows, const std::vector<int>& other_blocks) {
  int longest = BatchMeans::kBlocks;
  for (const int blocks : other_blocks) longest = std::max(longest, blocks);
  return longest * block_rows;
}

}  // namespace framewatch::estimator
