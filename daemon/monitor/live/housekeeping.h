// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <future>
#include <string>
#include <vector>

#include <framewatch/service_t.hpp>

#include "daemon/base/clocks.h"
#include "daemon/config/config.h"
#include "daemon/monitor/estimation/gap_files.h"
#include "daemon/monitor/events/raised_events.h"
#include "daemon/monitor/live/intake_monitor.h"
#include "daemon/monitor/live/live_estimation.h"
#include "daemon/monitor/live/reloader.h"
#include "daemon/monitor/service/progress_watch.h"
#include "daemon/monitor/service/service_manager.h"

namespace framewatch::daemon {

/// Writes the state of a running estimation periodically from a thread, so that a slow disk does
/// not delay estimates.
class StateKeeper {
 public:
  /// Without a `path` it writes nothing. `every_s` is the period.
  StateKeeper(std::string path, int every_s);

  /// Starts a write when one is due. `config` is that of the estimation.
  void update(const Config& config, Estimation& estimation, std::int64_t now_us);
  /// Makes the next write due at once, because the stored state belongs to an old configuration.
  void soon() { next_us_ = 1; }
  /// Writes now and waits until the write is done.
  void keep(const Config& config, Estimation& estimation);

  bool wanted() const { return !path_.empty(); }
  const std::string& path() const { return path_; }
  std::int64_t written_us() const { return written_us_; }  ///< host clock; 0: not yet
  const std::string& problem() const { return problem_; }  ///< of the newest write; empty: success

 private:
  bool written();
  void report(std::string problem);

  std::string path_;
  std::int64_t every_us_, next_us_ = 0, written_us_ = 0;
  std::string problem_;
  std::future<std::string> writing_;  ///< of std::async: its destructor waits
};

/// The periodic tasks of `framewatch run` besides the estimation: warnings in the log, status
/// messages, state file, learned baseline, replaced gap model, systemd's watchdog, and reload.
class Housekeeping {
 public:
  /// `config` must outlive this; `text` is its source. Without a `state_path` no state is written.
  /// `resumed`: the run continues from a state file.
  Housekeeping(const Config& config, const std::string& text, const std::string& state_path,
               int state_every_s, const StartCount& starts, bool resumed);

  /// Does the tasks that are due. Call it several times a second. `raised` holds all raised events
  /// of this process.
  void update(LiveEstimation& live, lcm::LCM& lcm, ServiceManager& manager,
              const std::vector<RaisedEvents*>& raised);
  /// Reads the configuration file again. Returns true if it was accepted; live.config() is then the
  /// new one.
  bool reload(LiveEstimation& live, ServiceManager& manager);
  /// Writes the state and waits until it is written.
  void write_state(LiveEstimation& live) { state_.keep(live.config(), live.estimation()); }

 private:
  void keep_baseline(const LiveEstimation& live);
  service_t service_report(const LiveEstimation& live, const std::vector<RaisedEvents*>& raised,
                           std::int64_t now_us) const;

  StateKeeper state_;
  IntakeWarnings intake_warnings_;
  CanWarnings can_warnings_;
  CanMonitor can_monitor_;
  estimator::Baseline written_baseline_;  ///< in the configured file
  GapKeeper gap_;
  Reloader reloader_;
  OnceASecond report_;
  ProgressWatch progress_;
  const Config& config_;  ///< the first one, for names that no reload changes
  const StartCount starts_;
  const bool resumed_;
  const std::int64_t started_us_;
};

}  // namespace framewatch::daemon
