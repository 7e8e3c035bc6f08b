#include "drivers/can/host_clock_steps.h"

namespace framewatch::drivers {

bool HostClockSteps::resolve(double step_us, double now_us) {
  int active = 0, same = 0;
  for (const StampedStream* stream : streams_) {
    const StampedStream::Vote vote = stream->vote(step_us, now_us);
    active += vote != StampedStream::Vote::abstains;
    same += vote == StampedStream::Vote::yes;
  }
  if (same < 2 || 2 * same < active) return false;
  total_us_ += step_us;
  ++count_;
  for (StampedStream* stream : streams_) stream->shift(step_us);
  return true;
}

}  // namespace framewatch::drivers
