#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace framewatch::daemon {

/// The configuration of the services that the package installs.
inline constexpr const char* kInstalledConfig = "/etc/framewatch/building.toml";

/// Reports the state of this process to systemd (sd_notify(3)); does nothing when it was not
/// started with Type=notify.
class ServiceManager {
 public:
  ServiceManager();

  /// Whether systemd listens; then a missing network is waited for instead of being an error.
  bool listens() const { return listens_; }
  void ready();
  /// One line for `systemctl status`; sent when it differs from the last one.
  void status(const std::string& line);
  /// Feeds the watchdog as often as it needs. To be called only while the program makes progress.
  void alive(std::int64_t now_us);
  void reloading();
  void stopping();

 private:
  bool listens_;
  std::int64_t feed_every_us_ = 0;  ///< 0: there is no watchdog
  std::int64_t next_feed_us_ = 0;
  std::string sent_;
};

/// The state of a service according to systemd.
struct UnitState {
  std::string active, sub, result;  ///< "active", "running", "success"
  std::int64_t restarts = 0;        ///< by systemd, since the service was started by hand
};

/// Empty when systemd does not run this machine, or has no such unit.
std::optional<UnitState> unit_state(const std::string& unit);

/// "active (running), restarted 3 times by systemd since it was last started by hand".
std::string unit_text(const UnitState& state);

/// What is wrong with the service; empty when nothing is.
std::string unit_oddity(const UnitState& state);

}  // namespace framewatch::daemon
