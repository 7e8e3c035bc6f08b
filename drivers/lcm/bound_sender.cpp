#include "drivers/lcm/bound_sender.h"

#include <algorithm>
#include <utility>

namespace framewatch::drivers {

bool BoundSender::takes(const LcmSender& sender, std::int64_t arrival_us) {
  if (sender == LcmSender{}) return true;
  // The receiver's clock may be set back.
  arrival_us_ = std::min(arrival_us_, arrival_us);
  contested_until_us_ = std::min(contested_until_us_, arrival_us + kHold_us);
  const bool nobody = bound_ == LcmSender{};
  if (sender != bound_ && !nobody && arrival_us - arrival_us_ <= kSilent_us) {
    other_ = sender;
    other_was_last_ = true;
    ++others;
    return false;
  }
  if (std::exchange(other_was_last_, false) && sender == bound_) {
    ++contests;
    contested_until_us_ = arrival_us + kHold_us;
  }
  bound_ = sender;
  arrival_us_ = arrival_us;
  return true;
}

}  // namespace framewatch::drivers
