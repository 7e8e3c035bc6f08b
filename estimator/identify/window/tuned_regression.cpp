#include "estimator/identify/window/tuned_regression.h"

#include <algorithm>
#include <utility>

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

}  // namespace framewatch::estimator
