// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

namespace framewatch::daemon {

enum class LogLevel { error = 3, warning = 4, notice = 5, info = 6, debug = 7 };

/// Writes one printable() line on stderr. Under systemd the prefix <N> gives journald its priority.
void log(LogLevel level, const std::string& message);

/// Logs at most one line per second and adds the number of suppressed lines. The caller passes the
/// time.
class RateLimitedLog {
 public:
  explicit RateLimitedLog(LogLevel level) : level_(level) {}
  void operator()(std::int64_t now_us, const std::string& message);

 private:
  LogLevel level_;
  std::int64_t next_us_ = INT64_MIN;
  std::int64_t held_back_ = 0;
};

}  // namespace framewatch::daemon
