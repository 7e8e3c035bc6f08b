#include "daemon/monitor/live/live_events.h"

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/log.h"
#include "daemon/monitor/events/acknowledge_messages.h"
#include "daemon/monitor/events/event_words.h"
#include "drivers/files/encoded.h"

namespace framewatch::daemon {

LiveEvents::LiveEvents(const Config& config, lcm::LCM& lcm, LiveEstimation& live,
                       HistoryReport& history)
    : config_(config),
      live_(live),
      history_(history),
      actions_(config, lcm),
      desk_(config, lcm,
            [this](const event_t& event, const Acknowledgement& by) { acknowledged(event, by); }),
      commands_(config, "run", [this](const CommandPacket& command, const std::string& user) {
        return obey(command, user);
      }) {
  actions_.raised_before(live_.estimation().raised());
}

void LiveEvents::acknowledged(const event_t& event, const Acknowledgement& by) {
  actions_.acknowledged(event);
  if (history_.history() != nullptr)
    history_.history()->message(config_.lcm.prefix + "ACKNOWLEDGED",
                                drivers::encoded(acknowledged_message(event, by)));
}

CommandPacket LiveEvents::obey(const CommandPacket& command, const std::string& user) {
  if (command.channel != "ACKNOWLEDGE") return refused("framewatch run acknowledges, nothing else");
  const auto answer = desk_.obey(command.bytes, user, raised(), host_clock_us());
  if (!answer) return refused("the request is not understood: another version?");
  return {"ACKNOWLEDGED", drivers::encoded(*answer)};
}

void LiveEvents::poll() {
  for (const event_t& event : live_.take_events()) {
    log(event.severity >= severity::warning ? LogLevel::warning : LogLevel::notice,
        fmt::format("{} {}: {}", event.kind, event.place, event.message));
    actions_.event(event, live_.estimation().raised().acknowledgement(event.id) != nullptr);
  }
  for (const std::vector<std::uint8_t>& request : live_.take_requests())
    desk_.heard(request, host_clock_us());
  for (const event_t& event : history_.check(host_clock_us()))
    actions_.event(event, history_.raised().acknowledgement(event.id) != nullptr);
  commands_.look(steady_clock_us());
  desk_.look(raised(), host_clock_us());
  actions_.look(host_clock_us());
}

}  // namespace framewatch::daemon
