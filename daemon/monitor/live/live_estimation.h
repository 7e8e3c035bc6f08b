#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/config/keys/option_table.h"
#include "daemon/config/sections/settings.h"
#include "daemon/monitor/estimation/estimation.h"
#include "daemon/monitor/estimation/gap_segments.h"
#include "daemon/monitor/event_report/event_report_files.h"
#include "daemon/monitor/history/history.h"
#include "daemon/monitor/live/live_intake.h"
#include "daemon/monitor/live/live_times.h"
#include "daemon/monitor/live/raw_backlog.h"
#include "drivers/can/can_log.h"

namespace framewatch::daemon {

/// Live estimation: takes samples from one LCM instance and from CAN buses, publishes estimates on
/// LCM, and feeds the history. All work is done inside poll().
class LiveEstimation : public EstimationListener {
 public:
  /// `lcm` must outlive this; with memq:// every sender and receiver must use it. `can_log` may be
  /// null; otherwise every frame of the buses is written to it.
  LiveEstimation(const Config& config, drivers::LcmProvider& lcm,
                 drivers::CanLogWriter* can_log = nullptr);

  /// Opens the configured buses. Returns one line for each problem.
  std::vector<std::string> open_buses() { return intake_.open_buses(); }

  /// Waits for messages at most `timeout_ms` and handles those that are there. False when LCM
  /// failed or the log of CAN frames cannot be written. Never throws, never stops on bad input.
  [[nodiscard]] bool poll(int timeout_ms);
  void finish() { estimation_->finish(); }
  /// From now on poll() first gives the estimation these samples, for at most kFeed_ms a call, and
  /// keeps what comes meanwhile for afterwards. They are not stored again.
  void catch_up(RawBacklog backlog);
  bool catching_up() const { return !backlog_.empty() || !later_.empty(); }
  /// From now on samples and published messages are stored there too; null: no longer.
  void record_to(History* history) { history_ = history; }
  /// Returns the events that were published since the last call, and forgets them.
  std::vector<event_t> take_events() { return std::exchange(events_, {}); }
  /// Returns the requests to acknowledge events, as received since the last call, and forgets them.
  std::vector<std::vector<std::uint8_t>> take_requests() { return std::exchange(requests_, {}); }
  const Estimation& estimation() const { return *estimation_; }
  Estimation& estimation() { return *estimation_; }
  /// The configuration it runs with; until the next reconfigure().
  const Config& config() const { return *config_; }
  /// Goes on with another configuration, one that reloaded() made of config(). No message is lost.
  void reconfigure(Config next, Reach reach);
  const LiveState& state() const { return state_; }
  static constexpr std::int64_t kFeed_ms = 50;
  static constexpr std::size_t kMaxLater = 1'000'000;  ///< messages and frames kept meanwhile
  static constexpr std::size_t kMaxEvents = 10'000;    ///< between two take_events()
  static constexpr std::size_t kMaxRequests = 16;  ///< between two take_requests(); senders repeat
  const LiveTimes& times() const { return times_; }
  /// Messages the LCM receiver dropped.
  drivers::ReceiverCounters dropped() const { return intake_.lcm().dropped(); }
  drivers::CanSource& can() { return intake_.can(); }

 private:
  /// Of a message or frame that came while the backlog was given.
  struct Later {
    std::string channel;  ///< empty: a frame
    std::vector<std::uint8_t> data;
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
  void on_temperature(const temperature_t& temperature) override;
  void on_gap(const estimator::GapNews& news) override;
  void on_event(const event_t& event) override;
  void on_shaken(const EventReport& report) override { reports_.write(report, *config_); }
  void begin_estimation();
  void step_done(std::int64_t began_us, std::int64_t windows_before, std::int64_t received_us);

  std::unique_ptr<const Config> config_;
  const drivers::CanMap can_map_;  ///< of the first configuration: the buses stay open
  drivers::LcmProvider& lcm_;
  drivers::CanLogWriter* can_log_;
  bool can_log_failed_ = false;
  std::int64_t can_dropped_ = 0, lcm_dropped_ = 0;
  LiveState state_;
  LiveTimes times_;
  std::optional<GapSegments> segments_;  ///< none: none are stored
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
};

}  // namespace framewatch::daemon
