#include "daemon/live/live_events.h"

#include "daemon/base/clocks.h"
#include "daemon/events/acknowledge_messages.h"
#include "drivers/base/encoded.h"

namespace framewatch::daemon {

LiveEvents::LiveEvents(const Config& config, lcm::LCM& lcm, LiveEstimation& live)
    : config_(config),
      live_(live),
      history_(config, lcm),
      actions_(config, lcm),
      desk_(config, lcm) {
  live_.record_to(history_.history());
  actions_.raised_before(live_.estimation().raised());
  live_.on_event([this](const event_t& event) {
    actions_.event(event, live_.estimation().raised().acknowledgement(event.id) != nullptr);
  });
}

void LiveEvents::look() {
  for (const event_t& event : history_.look(host_clock_us()))
    actions_.event(event, history_.raised().acknowledgement(event.id) != nullptr);
  const auto acknowledged = [this](const event_t& event, const Acknowledgement& by) {
    actions_.acknowledged(event);
    if (history_.history() != nullptr)
      history_.history()->message(config_.lcm.prefix + "ACKNOWLEDGED",
                                  drivers::encoded(acknowledged_message(event, by)));
  };
  desk_.look({&live_.estimation().raised(), &history_.raised()}, acknowledged, host_clock_us());
  actions_.look(host_clock_us());
}

}  // namespace framewatch::daemon
