// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include <framewatch/event_t.hpp>

#include "daemon/base/local_time.h"
#include "daemon/config/config.h"
#include "daemon/monitor/service/health.h"

namespace framewatch::daemon {

/// Returns the daily message of what is heard: that all is well, or what is not. `now_us`: host
/// clock.
event_t well_event(const Heard& heard, const Config& config, std::int64_t now_us);

/// Decides when the daily message is due.
class DailyTime {
 public:
  /// Never due.
  DailyTime() = default;
  /// `at`: such as "08:00"; anything else is never due.
  DailyTime(const std::string& at, const std::string& zone);

  /// Returns true once a day, at the time or at the first call after it. The first call of all is
  /// due only up to 5 minutes after the time. `now_us`: host clock.
  bool due(std::int64_t now_us);

 private:
  std::optional<int> at_min_;
  std::optional<TimeZone> zone_;
  std::string done_;  ///< day; empty before the first call
};

/// Makes the daily message of [actions]. It listens to what the program publishes, as `framewatch
/// status` does, in a thread, so that the message shows that the whole way works.
class DailyWell {
 public:
  DailyWell() = default;
  /// Waits until the thread, which listens, has stopped.
  ~DailyWell();
  DailyWell(const DailyWell&) = delete;
  DailyWell& operator=(const DailyWell&) = delete;

  /// `url`: where the program publishes; empty: as configured.
  void configure(const Config& config, const std::string& url);
  /// Returns the message when it is ready. Call it several times a second; `now_us`: host clock.
  std::optional<event_t> update(std::int64_t now_us);

 private:
  std::shared_ptr<const Config> config_;
  std::string url_, at_, time_zone_;
  DailyTime time_;
  std::atomic<bool> stop_ = false;
  std::future<event_t> listening_;
};

}  // namespace framewatch::daemon
