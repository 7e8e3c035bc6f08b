#pragma once

#include <cstdint>
#include <string>

namespace framewatch::daemon {

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

}  // namespace framewatch::daemon
