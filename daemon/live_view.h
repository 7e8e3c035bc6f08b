#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <framewatch/acknowledge_t.hpp>
#include <framewatch/acknowledged_t.hpp>
#include <framewatch/gap_t.hpp>
#include <framewatch/service_t.hpp>
#include <framewatch/session_command_t.hpp>
#include <framewatch/session_status_t.hpp>
#include <framewatch/status_t.hpp>

#include "daemon/change_watch.h"
#include "daemon/config.h"
#include "daemon/event_ring.h"
#include "daemon/publisher.h"
#include "drivers/accel_intake.h"
#include "estimator/motion/acquisition.h"

namespace framewatch::daemon {

/// What the page shows, made of LCM messages alone: samples, estimates, status and events in,
/// server sent events (JSON) out. message() and flush() belong to one thread; what viewers call is
/// guarded.
class LiveView {
 public:
  /// `config` must outlive this. publish: where events that were found here go (LCM).
  LiveView(const Config& config, MessageSink publish);

  /// Every channel the page is fed by.
  std::vector<std::string> channels() const;
  void message(const std::string& channel, const void* data, std::size_t size);
  /// Gives out what has come since; to be called 20 times a second.
  void flush();

  /// The building, its sensors and parameters, as the page draws them: JSON.
  std::string building_json() const;
  EventRing::Cursor join();
  std::size_t read(EventRing::Cursor& cursor, char* buffer, std::size_t size);
  /// False when there is no such event.
  bool acknowledge(std::int64_t id);
  /// The stiffnesses of the next seconds are what later ones are compared with.
  void renew_baseline();
  /// Goes to `framewatch record` with the next flush(). False when too many wait.
  bool tell_recorder(const session_command_t& command);

 private:
  void keep(const SampleSet& set);
  void parameters(const void* data, std::size_t size);
  void estimate(const std::string& channel, const void* data, std::size_t size);
  void event(const event_t& event);
  void still_raised(const service_t& service);
  void acknowledged(acknowledged_t acknowledged);
  void status(const std::string& name, std::string& kept, std::string json);
  void send_commands();
  std::string status_json(const status_t& status) const;
  std::string event_json(const event_t& event) const;
  std::string baseline_json() const;
  void push(const std::string& name, const std::string& data);

  const Config& config_;
  MessageSink publish_;
  std::string watched_channel_;
  Acquisition acquisition_;
  drivers::AccelIntake intake_;
  std::optional<parameter_table_t> table_;
  std::optional<ChangeWatch> watch_;
  std::optional<window_estimate_t> newest_;
  std::int64_t estimates_ = 0;  ///< since the last flush
  int flushes_ = 0, stride_ = 1;
  std::string rows_;  ///< of the next motion event
  std::int64_t first_row_us_ = 0;
  std::size_t row_count_ = 0, rows_left_out_ = 0;

  mutable std::mutex mutex_;  ///< guards what is below
  EventRing ring_;
  std::map<std::int64_t, event_t> events_;
  std::set<std::int64_t> acknowledged_here_;    ///< where nobody else keeps it
  std::optional<acknowledged_t> acknowledged_;  ///< as `framewatch run` says
  std::string status_, baseline_, session_, gap_, can_;
  std::vector<session_command_t> commands_;
  std::vector<acknowledge_t> requests_;
  bool renew_ = false;
};

}  // namespace framewatch::daemon
