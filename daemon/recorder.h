#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <framewatch/session_command_t.hpp>
#include <framewatch/session_status_t.hpp>

#include "daemon/channel_check.h"
#include "daemon/config.h"
#include "daemon/message_ring.h"
#include "daemon/rest_level.h"
#include "daemon/session_file.h"
#include "daemon/session_log.h"
#include "daemon/tap_test.h"
#include "drivers/accel_intake.h"
#include "drivers/can/can_intake.h"
#include "estimator/motion/acquisition.h"

namespace framewatch::daemon {

enum class RecorderState { waiting, tapping, armed, recording };

/// Acquisition sessions: raw samples and estimates into the logs of a folder per session, a check
/// of the channels before it, a trigger. Nothing here estimates or reports: what can fail does so
/// elsewhere. Host time is the caller's, microseconds.
class Recorder {
 public:
  /// Called with a session's folder when its files are closed.
  using Ended = std::function<void(const std::string& folder)>;

  /// `config` must outlive this. Sessions become folders in `sessions`.
  Recorder(const Config& config, std::string sessions, Ended ended);

  /// LCM channels that are stored.
  std::vector<std::string> channels() const;
  void message(const std::string& channel, const void* data, std::size_t size,
               std::int64_t received_us);
  void frame(int bus, const drivers::CanFrame& frame);
  /// To be called ten times a second at least.
  void tick(std::int64_t now_us);

  // Empty when it is so, else why it cannot be.
  /// Arms when the request has a trigger, else starts at once.
  std::string begin(const SessionRequest& request, std::int64_t now_us);
  std::string tap();
  /// Ends the session half a second later, or the tap test, or disarms.
  std::string stop(const std::string& why, std::int64_t now_us);
  /// Does what a command says, once for each id, and lets the status answer it.
  void obey(const session_command_t& command, std::int64_t now_us);

  RecorderState state() const { return state_; }
  /// Whether a check of the channels is there.
  bool checked() const { return !check_results_.empty(); }
  /// Of the newest check, or of the running session.
  std::vector<ChannelResult> channel_results() const;
  const std::string& news() const { return news_; }
  session_status_t status(std::int64_t now_us) const;
  /// What became of a session: the name of its folder when it has a report there, and a sentence.
  void finished(const std::string& report, const std::string& news);

 private:
  void store(KeptMessage message);
  void keep(const SampleSet& set);
  void look_for_tap(const std::vector<double>& distance);
  void look_for_trigger(const std::vector<double>& distance);
  std::string open(std::int64_t now_us, const std::string& triggered_by);
  void close();
  void look_at_disk(std::int64_t now_us);
  void write_session_file();
  std::int64_t lost() const;

  const Config& config_;
  std::string sessions_;
  Ended ended_;
  Acquisition acquisition_;
  drivers::AccelIntake intake_;
  drivers::CanIntake can_;
  RestLevel rest_;
  ChannelCheck check_;
  TapTest taps_;
  std::vector<std::size_t> trigger_axes_;
  MessageRing before_;
  std::map<std::string, KeptMessage> tables_;  ///< the newest of each

  RecorderState state_ = RecorderState::waiting;
  std::vector<ChannelResult> check_results_;
  std::vector<int> polarity_;
  std::string news_, report_, folder_;
  std::int64_t newest_us_ = 0, now_us_ = 0, answered_ = 0;
  std::string refused_;

  SessionFile session_;
  std::unique_ptr<SessionLog> log_;
  std::int64_t lost_before_ = 0, close_at_us_ = 0, trouble_said_us_ = 0;
  bool disk_failing_ = false;
};

}  // namespace framewatch::daemon
