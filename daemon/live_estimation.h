#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <lcm/lcm-cpp.hpp>

#include "daemon/config_changes.h"
#include "daemon/estimation.h"
#include "daemon/gap_segments.h"
#include "daemon/history.h"
#include "daemon/live_times.h"
#include "drivers/can/can_log.h"
#include "drivers/can/can_source.h"
#include "drivers/lcm_source.h"

namespace framewatch::daemon {

/// Live estimation: samples from one LCM instance and from CAN, estimates to LCM. poll() until
/// satisfied.
class LiveEstimation {
 public:
  /// `config` and `lcm` must outlive this. For memq:// everybody shares `lcm`.
  /// `can_log`, if any, gets every frame of the buses.
  LiveEstimation(const Config& config, lcm::LCM& lcm, drivers::CanLogWriter* can_log = nullptr);

  /// Opens the buses of the configuration; what is not as it should be, one line each.
  std::vector<std::string> open_buses() { return can_.open(); }

  /// Waits for messages at most `timeout_ms` and handles those that are there. False when LCM
  /// failed or the log of CAN frames cannot be written. Never throws, never stops on bad input.
  [[nodiscard]] bool poll(int timeout_ms);
  void finish() { estimation_->finish(); }
  /// From now on raw samples and everything that is published go there too; null: no more.
  void record_to(History* history) { history_ = history; }
  /// From now on every event that is published goes there too.
  void tell(std::function<void(const event_t&)> tell) { tell_ = std::move(tell); }
  const Estimation& estimation() const { return *estimation_; }
  Estimation& estimation() { return *estimation_; }
  /// Goes on under the settings of another configuration, which `running`, the one this was made
  /// with, takes over. No message is lost.
  void reconfigure(Config& running, const Config& fresh, Reach reach);
  const LiveState& state() const { return state_; }
  const LiveTimes& times() const { return times_; }
  drivers::CanSource& can() { return can_; }

 private:
  void on_message(const std::string& channel, const void* data, std::size_t size,
                  std::int64_t received_us);
  void on_frame(int bus, const drivers::CanFrame& frame);
  void on_sample(const AccelSample& sample);
  void begin_estimation();
  void step_done(std::int64_t began_us, std::int64_t windows_before, std::int64_t received_us);

  const Config& config_;
  lcm::LCM& lcm_;
  drivers::CanLogWriter* can_log_;
  bool can_log_failed_ = false;
  std::int64_t can_dropped_ = 0;
  LiveState state_;
  LiveTimes times_;
  std::optional<GapSegments> segments_;  ///< none: none are stored
  History* history_ = nullptr;
  std::function<void(const event_t&)> tell_;
  std::unique_ptr<Estimation> estimation_;
  drivers::LcmSource source_;
  drivers::CanSource can_;
};

}  // namespace framewatch::daemon
