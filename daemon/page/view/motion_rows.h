#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "estimator/motion/sample.h"
#include "estimator/shaking/story_response.h"

namespace framewatch::daemon {

/// Behind the channels the motion of every frame, the base's first.
estimator::SampleSet with_every_floor(estimator::SampleSet set,
                                      const estimator::Structure& structure,
                                      const estimator::StoryResponse& response);

/// Collects calibrated instants for the page's next "motion" event: every stride-th one, so that at
/// most kMaxRate_hz go to the page.
class MotionRows {
 public:
  static constexpr double kMaxRate_hz = 200;
  static constexpr std::size_t kMaxRows = 200;  ///< of one event; more are left out and counted

  /// rate_hz: of the instants.
  explicit MotionRows(double rate_hz);

  void push(const estimator::SampleSet& instant);
  /// The collected rows as JSON, which are then forgotten; empty when there are none.
  std::string take();
  int stride() const { return stride_; }

 private:
  int stride_;
  std::string rows_;
  std::int64_t first_us_ = 0;
  std::size_t count_ = 0, left_out_ = 0;  ///< left_out_: ever
};

}  // namespace framewatch::daemon
