// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <framewatch/parameter_table_t.hpp>
#include <framewatch/session_command_t.hpp>
#include <framewatch/weather_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include "daemon/config/config.h"
#include "daemon/monitor/estimation/publisher.h"
#include "daemon/monitor/service/latest_messages.h"
#include "daemon/page/findings/answers.h"
#include "daemon/page/findings/finding.h"
#include "daemon/page/findings/shaking.h"
#include "daemon/page/view/event_ring.h"
#include "daemon/page/view/mode_errors.h"
#include "daemon/page/view/page_alarms.h"
#include "daemon/page/view/page_commands.h"
#include "daemon/page/view/page_history.h"
#include "daemon/page/view/page_watch.h"
#include "daemon/page/view/stored_history.h"
#include "drivers/lcm/accel_intake.h"
#include "estimator/motion/acquisition.h"

namespace framewatch::daemon {

/// Turns LCM messages (samples, estimates, status, events) into the server-sent events that the
/// page shows. Call restore(), message() and flush() from one thread; all other functions may be
/// called from any thread.
class LiveView {
 public:
  /// `config` must outlive this. publish: sends events that the page finds to LCM. give: sends a
  /// command of a viewer to a daemon; called in a separate thread.
  LiveView(const Config& config, MessageSink publish, PageCommands::Give give);

  /// Loads stored estimates, events and samples. Call it before message(). now_us: host clock.
  void restore(const StoredHistory& stored, std::int64_t now_us);
  const Config& config() const { return config_; }
  /// Returns the LCM channels to subscribe to.
  std::vector<std::string> channels() const;
  /// Takes one LCM message. Ignores other channels and malformed payloads. received_us: host clock.
  void message(const std::string& channel, const void* data, std::size_t size,
               const drivers::LcmSender& sender = {}, std::int64_t received_us = 0);
  /// Takes a sample that did not come over LCM.
  void sample(const estimator::AccelSample& sample);
  /// Pushes events for everything that has changed since the last call. Call it 20 times a second.
  void flush();

  /// Returns the building with its sensors and parameters as JSON.
  std::string building_json() const;
  /// Returns PageHistory::json().
  std::string history_json() const;
  /// Returns the position of a viewer that joins now; it first reads the current state.
  EventRing::Cursor join();
  /// Reads events as EventRing::read() does.
  std::size_t read(EventRing::Cursor& cursor, char* buffer, std::size_t size);
  /// Acknowledges the event `id` for `viewer` (an address). Returns 0 when the page itself found
  /// the event; otherwise the id of the request to `framewatch run`, which an event "refused" names
  /// if the request fails. Returns nullopt when the event does not exist or too many requests wait.
  std::optional<std::int64_t> acknowledge(std::int64_t id, const std::string& viewer);
  /// Learns the baseline of the page anew from the next seconds. Returns false with [watch], where
  /// `framewatch run` keeps the baseline.
  bool renew_baseline();
  /// Sends a command to `framewatch record`. Returns false when too many commands wait.
  bool tell_recorder(const session_command_t& command);
  enum class ReadingOutcome {
    taken,
    unknown_name,  ///< no [[weather]] has it
    no_time,       ///< no estimate has told the sensors' clock yet
    full           ///< kMostReadings wait
  };
  /// Takes a reading of weather, which flush() sends to `framewatch run` over LCM. value: in the
  /// unit of the name. time_us: sensor time; nullopt: that of the newest estimate.
  ReadingOutcome reading(const std::string& name, double value,
                         std::optional<std::int64_t> time_us);

 private:
  static constexpr std::size_t kMostReadings = 100;
  void send_readings();
  void show(DaemonMessage changed);
  void show_alarms(DaemonMessage changed);
  void parameters(const parameter_table_t& table);
  void estimate(int window, const window_estimate_t& estimate);
  void other_estimate(const std::string& channel, std::span<const std::uint8_t> payload);
  void detect_changes(int window, const window_estimate_t& estimate);
  /// Returns true for a change of stiffness that the page found, as it does without [watch].
  bool found_here(const event_t& event) const;
  void show_modes();
  void keep(const std::string& name, std::string json);
  void push(const std::string& name, const std::string& data);
  void push_alarms(const std::vector<std::string>& alarms);
  void instant(const estimator::SampleSet& instant);
  void push_if_new(const std::string& name, const std::string& json);
  /// Returns the baseline by parameter; empty while none is known.
  std::vector<double> baseline() const;
  bool watched(std::size_t parameter) const;
  Known known() const;
  double seconds_since(std::int64_t flush) const;

  const Config& config_;
  MessageSink publish_;
  std::vector<std::string> estimate_channels_;  ///< by window, without the long one
  LatestMessages latest_;
  MotionRows motion_;
  estimator::Acquisition acquisition_;
  drivers::AccelIntake intake_;
  std::vector<std::string> parameters_;  ///< names; empty: not known yet
  std::optional<PageWatch> watch_;
  std::optional<window_estimate_t> newest_;
  bool new_estimate_ = false;  ///< since the last flush
  bool new_values_ = true;     ///< since the modes were computed
  bool late_rows_ = false;     ///< rows of history_ got values since the last flush
  std::int64_t flushes_ = 0, motion_at_ = 0, estimate_at_ = 0;  ///< times in flushes
  Shaking shaking_;
  bool grouped_;                  ///< parameters describe groups of stories
  bool same_parameters_ = false;  ///< the estimator has the parameters of config_
  ModelFit fit_;
  ModeErrors mode_errors_;
  NewestEventReport reports_;
  bool same_config_ = true;

  mutable std::mutex mutex_;  ///< guards the members below
  EventRing ring_;
  PageAlarms alarms_;
  PageHistory history_;
  double silent_s_ = 0;                      ///< since the newest sample
  std::map<std::string, std::string> kept_;  ///< newest JSON by event name, for viewers that join
  bool renew_ = false;
  std::optional<std::int64_t> newest_us_;                    ///< sensor time of the newest estimate
  std::vector<std::pair<std::string, weather_t>> readings_;  ///< by LCM channel, to be sent

  PageCommands commands_;  ///< last, because its thread pushes events
};

}  // namespace framewatch::daemon
