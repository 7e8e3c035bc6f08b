#pragma once

#include "daemon/config/config.h"
#include "daemon/monitor/actions/acknowledge_desk.h"
#include "daemon/monitor/actions/action_report.h"
#include "daemon/monitor/history/history_report.h"
#include "daemon/monitor/live/live_estimation.h"
#include "daemon/monitor/service/command_socket.h"

namespace framewatch::daemon {

/// What `framewatch run` does with events: hands those of the estimation and of the history to the
/// command and the webhook of [actions], and acknowledges them on request.
class LiveEvents {
 public:
  /// All must outlive this.
  LiveEvents(const Config& config, lcm::LCM& lcm, LiveEstimation& live, HistoryReport& history);
  LiveEvents(const LiveEvents&) = delete;
  LiveEvents& operator=(const LiveEvents&) = delete;

  /// Handles new events and requests. Call it several times a second.
  void poll();
  /// Goes on with another configuration, of which [actions] may differ.
  void reconfigure(const Config& config) { actions_.reconfigure(config); }

  /// Returns the raised events of the estimation and of the history.
  AcknowledgeDesk::Raised raised() { return {&live_.estimation().raised(), &history_.raised()}; }

 private:
  void acknowledged(const event_t& event, const Acknowledgement& by);
  CommandPacket obey(const CommandPacket& command, const std::string& user);

  const Config& config_;
  LiveEstimation& live_;
  HistoryReport& history_;
  ActionReport actions_;
  AcknowledgeDesk desk_;
  CommandSocket commands_;
};

}  // namespace framewatch::daemon
