// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "daemon/config/config.h"
#include "drivers/lcm/lcm_provider.h"

namespace framewatch::daemon {

/// The configuration that the package's services use.
inline constexpr const char* kInstalledConfig = "/etc/framewatch/building.toml";

/// Reports the state of this process to systemd (sd_notify(3)). Does nothing unless the service has
/// Type=notify.
class ServiceManager {
 public:
  ServiceManager();

  /// Returns true if systemd listens. The program then waits for a missing network instead of
  /// failing.
  bool listens() const { return listens_; }
  /// Tells systemd that the service is ready, also after reloading().
  void ready();
  /// Sets the line of `systemctl status`. Sends it only if it differs from the last one.
  void status(const std::string& line);
  /// Feeds the watchdog as often as necessary. Call it only while the program makes progress.
  void alive(std::int64_t now_us);
  void reloading();
  void stopping();

 private:
  bool listens_;
  std::int64_t feed_every_us_ = 0;  ///< 0: no watchdog
  std::int64_t next_feed_us_ = 0;
  std::string sent_;
};

/// The state of a service according to systemd.
struct UnitState {
  std::string active, sub, result;  ///< such as "active", "running", "success"
  std::int64_t restarts = 0;        ///< by systemd, since somebody started the service
};

/// Asks systemd for the state of a unit. Returns nullopt if systemd does not run this machine or
/// has no such unit.
std::optional<UnitState> unit_state(const std::string& unit);

/// Returns "active (running), restarted 3 times by systemd since somebody started it".
std::string unit_text(const UnitState& state);

/// Returns what is wrong with the service and what to do; empty if all is well.
std::string unit_oddity(const UnitState& state);

/// Opens LCM on `url`, or as configured if that is empty. Under a service manager it retries until
/// the network is up, because the machine may just have booted. Returns nullptr and sets `error`
/// when LCM cannot start or the program is stopped.
std::unique_ptr<drivers::LcmProvider> open_lcm_with_retry(const Config& config,
                                                          const std::string& url,
                                                          ServiceManager& manager,
                                                          std::string& error);

/// Counts the starts of the daemon with one state file, in the file STATE.starts beside it. Shows a
/// daemon that keeps crashing and restarting.
struct StartCount {
  std::int64_t starts = 0;          ///< including this one; 0: not counted
  std::int64_t unclean_starts = 0;  ///< starts after a run that did not stop cleanly
};

/// Adds one start to the count beside the state file `state_path`, and returns the new count. An
/// unreadable or missing count is taken as zero. Sets `problem` to why the count cannot be stored,
/// or to an empty string.
StartCount count_start(const std::string& state_path, std::string& problem);
/// Records that this run stops cleanly. Returns an empty string, or why that could not be stored.
std::string count_clean_stop(const std::string& state_path, const StartCount& count);

}  // namespace framewatch::daemon
