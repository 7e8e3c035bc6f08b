#include "daemon/page/view/motion_rows.h"

#include <algorithm>
#include <cmath>

#include "daemon/base/json.h"

namespace framewatch::daemon {

estimator::SampleSet with_every_floor(estimator::SampleSet set, const estimator::Structure& s,
                                      const estimator::StoryResponse& response) {
  for (int floor = 0; floor <= s.stories; ++floor)
    for (int f = 0; f < s.frames(); ++f) set.accel.push_back(response.floor_accel_mps2(floor, f));
  return set;
}

MotionRows::MotionRows(double rate_hz)
    : stride_(std::max(1, static_cast<int>(std::ceil(rate_hz / kMaxRate_hz)))) {}

void MotionRows::push(const estimator::SampleSet& instant) {
  if (instant.index % stride_ != 0) return;
  if (count_ == kMaxRows) {
    ++left_out_;
    return;
  }
  const std::int64_t time_us = to_microseconds(instant.time);
  if (count_ == 0) first_us_ = time_us;
  rows_ += fmt::format("{}[{},{}]", count_ == 0 ? "" : ",", time_us - first_us_,
                       json_list(instant.accel, "{:.5g}"));
  ++count_;
}

std::string MotionRows::take() {
  if (count_ == 0) return {};
  std::string out =
      fmt::format(R"({{"first_us":{},"rows":[{}],"left_out":{}}})", first_us_, rows_, left_out_);
  count_ = 0;
  rows_.clear();
  return out;
}

}  // namespace framewatch::daemon
