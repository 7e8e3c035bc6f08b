#pragma once

#include <cstdint>
#include <string>

namespace framewatch::daemon {

/// What systemd is told of this process (sd_notify(3), by libsystemd); nothing when it was not
/// started with Type=notify.
class ServiceManager {
 public:
  ServiceManager();

  /// Whether somebody listens: then what is missing now, as a network, is waited for.
  bool listens() const { return listens_; }
  void ready();
  /// One line for `systemctl status`; told when it differs from the last one.
  void status(const std::string& line);
  /// The watchdog is fed, as often as it wants. To be called only when work goes on as it should.
  void alive(std::int64_t now_us);
  void reloading();
  void stopping();

 private:
  bool listens_;
  std::int64_t feed_every_us_ = 0;  ///< 0: there is no watchdog
  std::int64_t next_feed_us_ = 0;
  std::string told_;
};

}  // namespace framewatch::daemon
