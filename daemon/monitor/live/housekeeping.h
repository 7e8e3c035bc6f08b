#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/monitor/estimation/baseline_keeper.h"
#include "daemon/monitor/estimation/gap_files.h"
#include "daemon/monitor/events/raised_events.h"
#include "daemon/monitor/live/intake_monitor.h"
#include "daemon/monitor/live/live_estimation.h"
#include "daemon/monitor/live/reloader.h"
#include "daemon/monitor/live/service_report.h"
#include "daemon/monitor/live/state_keeper.h"
#include "daemon/monitor/service/progress_watch.h"
#include "daemon/monitor/service/service_manager.h"
#include "daemon/monitor/service/start_count.h"

namespace framewatch::daemon {

/// The periodic tasks of `framewatch run` beside the estimation: warnings in the log, status
/// messages, state file, learned baseline, exchanged gap model, systemd's watchdog, and reload.
class Housekeeping {
 public:
  /// `config` must outlive this; text: what it was made of. state_path: empty: no state is kept.
  /// resumed: the run goes on from a state file.
  Housekeeping(const Config& config, const std::string& text, const std::string& state_path,
               int state_every_s, const StartCount& starts, bool resumed);

  /// To be called several times a second. raised: every event of this process that is raised.
  void update(LiveEstimation& live, lcm::LCM& lcm, ServiceManager& manager,
            const std::vector<RaisedEvents*>& raised);
  /// Reads the configuration anew. Whether it was accepted: then live.config() is a new one.
  bool reload(LiveEstimation& live, ServiceManager& manager);
  /// Writes the state and waits for it.
  void write_state(LiveEstimation& live) { state_.keep(live.config(), live.estimation()); }

 private:
  StateKeeper state_;
  IntakeWarnings intake_warnings_;
  CanWarnings can_warnings_;
  CanMonitor can_monitor_;
  BaselineKeeper baseline_;
  GapKeeper gap_;
  Reloader reloader_;
  ServiceReport report_;
  ProgressWatch progress_;
  const Config& config_;  ///< the first one: names that no reload changes
};

}  // namespace framewatch::daemon
