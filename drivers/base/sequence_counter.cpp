#include "drivers/base/sequence_counter.h"

namespace framewatch::drivers {

SequenceCounter::Verdict SequenceCounter::restart(std::int64_t sequence, std::int64_t time_us) {
  started_ = true;
  newest_ = sequence;
  newest_time_us_ = time_us;
  seen_ = ~std::uint64_t{0};  // what came before is not missed
  ++received;
  return Verdict::fresh;
}

SequenceCounter::Verdict SequenceCounter::see(std::int64_t sequence, std::int64_t time_us) {
  if (!started_) return restart(sequence, time_us);
  std::int64_t step = 0;
  if (__builtin_sub_overflow(sequence, newest_, &step) || step > kMaxJump) {
    ++restarts;
    return restart(sequence, time_us);
  }
  if (step > 0) {
    lost += step - 1;
    seen_ = (step < kWindow ? seen_ << step : 0) | 1;
    newest_ = sequence;
    ++received;
    const bool is_backwards = time_us <= newest_time_us_;
    newest_time_us_ = time_us;
    if (!is_backwards) return Verdict::fresh;
    ++backwards;
    return Verdict::backwards;
  }
  if (time_us > newest_time_us_) {
    ++restarts;
    return restart(sequence, time_us);
  }
  if (step <= -kWindow) {
    ++restarts;
    ++backwards;
    restart(sequence, time_us);
    return Verdict::backwards;
  }
  const std::uint64_t bit = std::uint64_t{1} << -step;
  if ((seen_ & bit) != 0) {
    ++duplicates;
    return Verdict::duplicate;
  }
  seen_ |= bit;
  --lost;
  ++reordered;
  ++received;
  return Verdict::fresh;
}

}  // namespace framewatch::drivers
