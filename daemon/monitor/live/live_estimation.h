// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/config/keys/option_table.h"
#include "daemon/config/sections/settings.h"
#include "daemon/monitor/estimation/estimation.h"
#include "daemon/monitor/estimation/gap_files.h"
#include "daemon/monitor/event_report/event_report_files.h"
#include "daemon/monitor/history/history.h"
#include "daemon/monitor/live/live_intake.h"
#include "daemon/monitor/live/mqtt_intake.h"
#include "daemon/monitor/live/raw_backlog.h"
#include "drivers/can/can_log.h"

namespace framewatch::daemon {

/// A histogram of durations.
class DurationCounts {
 public:
  /// Upper limits, s.
  static constexpr std::array kLimit_s = {1e-5,
                                          2.5e-5,
                                          5e-5,
                                          1e-4,
                                          2.5e-4,
                                          5e-4,
                                          1e-3,
                                          2.5e-3,
                                          5e-3,
                                          1e-2,
                                          2.5e-2,
                                          5e-2,
                                          1e-1,
                                          2.5e-1,
                                          5e-1,
                                          1.0,
                                          std::numeric_limits<double>::infinity()};

  void add(double seconds) {
    const auto limit = std::lower_bound(kLimit_s.begin(), kLimit_s.end() - 1, seconds);
    ++counts_[static_cast<std::size_t>(limit - kLimit_s.begin())];
    sum_s_ += seconds;
  }
  const std::array<std::int64_t, kLimit_s.size()>& counts() const { return counts_; }
  double sum_s() const { return sum_s_; }

 private:
  std::array<std::int64_t, kLimit_s.size()> counts_{};
  double sum_s_ = 0;
};

/// How punctual a live process is: durations, missed deadlines and newest samples.
struct LiveTimes {
  DurationCounts steps;              ///< time spent on each message or frame
  DurationCounts latencies;          ///< from the arrival of a sample to its estimate
  std::int64_t deadline_missed = 0;  ///< estimates later than the hop between two windows
  std::int64_t received_us = 0;      ///< host clock at the newest sample; 0: no sample yet
  std::vector<std::int64_t>
      newest_us;  ///< sensor time of the newest sample by axis; 0: no sample yet
};

/// Runs an estimation live: takes samples from one LCM instance and from CAN buses, publishes
/// estimates on LCM, and feeds the history. Does all work inside poll().
class LiveEstimation : public EstimationListener {
 public:
  /// `lcm` must outlive this; with memq:// all senders and receivers must use it. `can_log` may be
  /// nullptr; otherwise every frame of the buses is written to it.
  LiveEstimation(const Config& config, drivers::LcmProvider& lcm,
                 drivers::CanLogWriter* can_log = nullptr);

  /// Opens the configured buses. Returns one line for each problem.
  std::vector<std::string> open_buses() { return intake_.open_buses(); }

  /// Begins to receive from the broker of [mqtt], if there is one.
  void connect_mqtt();

  /// Waits for messages at most `timeout_ms` and handles all that have come. Returns false when LCM
  /// failed or the log of CAN frames cannot be written. Never throws, never stops on bad input.
  [[nodiscard]] bool poll(int timeout_ms);
  void finish() { estimation_->finish(); }
  /// Makes poll() pass these samples to the estimation first, for at most kFeed_ms a call, and keep
  /// newer input until they are done. They are not stored again.
  void catch_up(RawBacklog backlog);
  /// Returns true while the backlog or input kept meanwhile waits.
  bool catching_up() const { return !backlog_.empty() || !later_.empty(); }
  /// Stores samples and published messages in `history` from now on; nullptr stops that.
  void record_to(History* history) { history_ = history; }
  /// Returns the events that were published since the last call, and forgets them.
  std::vector<event_t> take_events() { return std::exchange(events_, {}); }
  /// Returns the requests to acknowledge events, as received since the last call, and forgets them.
  std::vector<std::vector<std::uint8_t>> take_requests() { return std::exchange(requests_, {}); }
  const Estimation& estimation() const { return *estimation_; }
  Estimation& estimation() { return *estimation_; }
  /// Returns the current configuration. The reference is valid until the next reconfigure().
  const Config& config() const { return *config_; }
  /// Continues with a configuration that reloaded() made of config(). Loses no message.
  void reconfigure(Config next, Reach reach);
  const LiveState& state() const { return state_; }
  static constexpr std::int64_t kFeed_ms = 50;
  static constexpr std::size_t kMaxLater =
      1'000'000;                                     ///< messages and frames kept during catch_up()
  static constexpr std::size_t kMaxEvents = 10'000;  ///< between two take_events()
  const LiveTimes& times() const { return times_; }
  /// Returns the counters of messages that the LCM receiver dropped.
  drivers::ReceiverCounters dropped() const { return intake_.lcm().dropped(); }
  drivers::CanSource& can() { return intake_.can(); }
  /// Returns the state of the connection to the broker of [mqtt]; nullopt without one. `now_us`:
  /// host clock.
  std::optional<mqtt_status_t> mqtt(std::int64_t now_us) const {
    return mqtt_ == nullptr ? std::nullopt : std::optional(mqtt_->status(now_us));
  }

 private:
  /// A message or frame that came during catch_up().
  struct Later {
    std::string channel = {};  ///< empty: a frame
    std::vector<std::uint8_t> data = {};
    drivers::LcmSender sender{};
    std::int64_t received_us = 0;
    int bus = 0;
    drivers::CanFrame frame{};
  };
  void feed();
  void keep(Later later);
  void estimate_message(const drivers::LcmMessage& message);
  void estimate_frame(int bus, const drivers::CanFrame& frame);
  void on_message(const drivers::LcmMessage& message);
  void on_frame(int bus, const drivers::CanFrame& frame);
  void on_sample(const estimator::AccelSample& sample) override;
  void on_weather(const std::string& channel, std::int64_t time_us,
                  const std::vector<std::uint8_t>& bytes) override;
  void on_gap(const estimator::GapNews& news) override;
  void on_event(const event_t& event) override;
  void on_shaken(const EventReport& report) override { reports_.write(report, *config_); }
  void begin_estimation();
  void step_done(std::int64_t began_us, std::int64_t windows_before, std::int64_t received_us);

  std::unique_ptr<const Config> config_;
  const drivers::CanMap can_map_;  ///< of the first configuration, because the buses stay open
  drivers::LcmProvider& lcm_;
  drivers::CanLogWriter* can_log_;
  bool can_log_failed_ = false;
  std::int64_t can_dropped_ = 0, lcm_dropped_ = 0;
  LiveState state_;
  LiveTimes times_;
  std::optional<GapSegments> segments_;  ///< empty: samples of gaps are not stored
  EventReportFiles reports_;
  History* history_ = nullptr;
  std::vector<event_t> events_;
  RawBacklog backlog_;
  bool feeding_ = false;
  std::deque<Later> later_;
  const std::string request_channel_;
  std::vector<std::vector<std::uint8_t>> requests_;
  std::unique_ptr<Estimation> estimation_;
  LiveIntake intake_;
  std::unique_ptr<MqttIntake> mqtt_;
};

}  // namespace framewatch::daemon
