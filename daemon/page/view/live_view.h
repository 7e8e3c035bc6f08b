#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <framewatch/parameter_table_t.hpp>
#include <framewatch/session_command_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include "daemon/config/config.h"
#include "daemon/monitor/estimation/message_sink.h"
#include "daemon/monitor/service/latest_messages.h"
#include "daemon/page/findings/answers.h"
#include "daemon/page/findings/finding.h"
#include "daemon/page/findings/shaking.h"
#include "daemon/page/view/event_ring.h"
#include "daemon/page/view/page_alarms.h"
#include "daemon/page/view/page_commands.h"
#include "daemon/page/view/page_history.h"
#include "daemon/page/view/page_watch.h"
#include "daemon/page/view/stored_history.h"
#include "drivers/lcm/accel_intake.h"
#include "estimator/motion/acquisition.h"

namespace framewatch::daemon {

/// What the page shows, made of LCM messages alone: samples, estimates, status and events in,
/// server-sent events (JSON) out. message() and flush() belong to one thread; the functions that
/// viewers call may be called from any thread.
class LiveView {
 public:
  /// `config` must outlive this. publish: where events of the page go (LCM). give: how commands of
  /// its viewers get to their daemons, called in a thread of its own.
  LiveView(const Config& config, MessageSink publish, PageCommands::Give give);

  /// What was stored before this began, for the viewers that come; to be called before message().
  /// now_us: of the host's clock.
  void restore(const StoredHistory& stored, std::int64_t now_us);
  /// The LCM channels the page is fed by.
  std::vector<std::string> channels() const;
  void message(const std::string& channel, const void* data, std::size_t size,
               const drivers::LcmSender& sender = {}, std::int64_t received_us = 0);
  /// Sends what has come since the last call; to be called 20 times a second.
  void flush();

  /// The building, its sensors and parameters, as the page draws them: JSON.
  std::string building_json() const;
  /// The last minutes (PageHistory): JSON.
  std::string history_json() const;
  EventRing::Cursor join();
  std::size_t read(EventRing::Cursor& cursor, char* buffer, std::size_t size);
  /// Id of the request that goes to `framewatch run`, whose refusal would come as an event
  /// "refused"; 0 when the event is the page's own. Empty when there is no such event, or too many
  /// requests wait. viewer: who it is, as far as the page knows.
  std::optional<std::int64_t> acknowledge(std::int64_t id, const std::string& viewer);
  /// The next seconds become the baseline that stiffnesses are compared with. False with [watch]:
  /// then it is that of `framewatch run`.
  bool renew_baseline();
  /// Goes to `framewatch record`. False when too many commands wait.
  bool tell_recorder(const session_command_t& command);

 private:
  void show(DaemonMessage changed);
  void show_alarms(DaemonMessage changed);
  void parameters(const parameter_table_t& table);
  void estimate(int window, const window_estimate_t& estimate);
  void other_estimate(const std::string& channel, std::span<const std::uint8_t> payload);
  void look_for_changes(int window, const window_estimate_t& estimate);
  /// Without [watch] changes of stiffness are found by pages, not by `framewatch run`.
  bool found_here(const event_t& event) const;
  void keep(const std::string& name, std::string json);
  void push(const std::string& name, const std::string& data);
  void push_alarms(const std::vector<std::string>& alarms);
  void sample(const estimator::AccelSample& sample);
  void instant(const estimator::SampleSet& instant);
  void push_if_new(const std::string& name, const std::string& json);
  /// What changes are judged against, and which of the parameters are.
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
  bool late_rows_ = false;     ///< rows of history_ have values now that they lacked
  std::int64_t flushes_ = 0, motion_at_ = 0, estimate_at_ = 0;  ///< flushes: the view's clock
  Shaking shaking_;
  bool grouped_;                  ///< parameters are of groups of stories
  bool same_parameters_ = false;  ///< the estimator's are the configuration's
  ModelFit fit_;
  NewestEventReport reports_;
  bool same_config_ = true;

  mutable std::mutex mutex_;  ///< guards what is below
  EventRing ring_;
  PageAlarms alarms_;
  PageHistory history_;
  double silent_s_ = 0;                      ///< since the newest sample
  std::map<std::string, std::string> kept_;  ///< newest JSON by event name, for viewers that join
  bool renew_ = false;

  PageCommands commands_;  ///< at the end: its thread pushes events
};

}  // namespace framewatch::daemon
