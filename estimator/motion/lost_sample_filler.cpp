#include "estimator/motion/lost_sample_filler.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace framewatch::estimator {

LostSampleFiller::LostSampleFiller(std::vector<std::uint8_t> repair) : repair_(std::move(repair)) {
  for (SampleSet& s : ring_) s.accel.resize(repair_.size());
  out_.accel.resize(repair_.size());
  repaired_.assign(repair_.size(), 0);
}

const SampleSet* LostSampleFiller::push(const SampleSet& set) {
  SampleSet& slot = ring_[static_cast<std::size_t>(next_)];
  slot.time = set.time;
  slot.index = set.index;
  std::copy(set.accel.begin(), set.accel.end(), slot.accel.begin());
  next_ = (next_ + 1) % 5;
  filled_ = std::min(filled_ + 1, 5);
  ++waiting_;
  if (filled_ == 5) repair();
  return waiting_ > kLookAhead ? give() : nullptr;
}

const SampleSet* LostSampleFiller::drain() {
  return waiting_ > 0 ? give() : nullptr;
}

const SampleSet* LostSampleFiller::give() {
  const SampleSet& oldest = held(waiting_ - 1);
  out_.time = oldest.time;
  out_.index = oldest.index;
  std::copy(oldest.accel.begin(), oldest.accel.end(), out_.accel.begin());
  --waiting_;
  return &out_;
}

void LostSampleFiller::repair() {
  if (held(0).index - held(4).index != 4) return;
  for (std::size_t a = 0; a < repaired_.size(); ++a) {
    double& x = held(2).accel[a];
    if (repair_[a] == 0 || !std::isnan(x)) continue;
    const double near = held(1).accel[a] + held(3).accel[a];
    const double far = held(0).accel[a] + held(4).accel[a];
    const double filled = (4 * near - far) / 6;
    if (!std::isfinite(filled)) continue;
    x = filled;
    ++repaired_[a];
  }
}

}  // namespace framewatch::estimator
