#include "daemon/monitor/live/live_intake.h"

#include <poll.h>

#include <utility>

#include "daemon/base/clocks.h"

namespace framewatch::daemon {

LiveIntake::LiveIntake(drivers::LcmProvider& lcm, const std::vector<std::string>& channels,
                       int queue_capacity, drivers::LcmSource::Handler on_message,
                       const drivers::CanMap& can, bool every_frame,
                       drivers::CanSource::Handler on_frame)
    : has_buses_(!can.empty()),
      lcm_(lcm, channels, queue_capacity, std::move(on_message)),
      can_(can, every_frame, std::move(on_frame)) {}

bool LiveIntake::poll(int timeout_ms) {
  if (!has_buses_) return lcm_.handle(timeout_ms);
  std::vector<pollfd> waiting{{lcm_.descriptor(), POLLIN, 0}};
  can_.descriptors(waiting);
  ::poll(waiting.data(), waiting.size(), timeout_ms);
  can_.handle(steady_clock_us());
  return lcm_.handle(0);
}

}  // namespace framewatch::daemon
