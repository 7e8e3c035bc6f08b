// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <framewatch/session_command_t.hpp>
#include <framewatch/session_status_t.hpp>

#include "daemon/config/config.h"
#include "daemon/tools/report/session_file.h"
#include "daemon/tools/session/axis_check.h"
#include "daemon/tools/session/session_log.h"
#include "drivers/can/can_intake.h"
#include "drivers/lcm/accel_intake.h"
#include "estimator/motion/acquisition.h"

namespace framewatch::daemon {

enum class RecorderState { waiting, tapping, armed, recording };

/// Records sessions: checks the channels, waits for a trigger, and writes raw samples and estimates
/// to the logs of a folder per session. It neither estimates nor writes reports, so their failure
/// costs no sample. The caller passes the host's time, microseconds.
class Recorder {
 public:
  /// Called with the folder of a session after its files are closed.
  using Ended = std::function<void(const std::string& folder)>;

  /// `config` must outlive this. Sessions become folders in `sessions`.
  Recorder(const Config& config, std::string sessions, Ended ended);

  /// Returns the LCM channels that are stored.
  std::vector<std::string> channels() const;
  void message(const std::string& channel, const void* data, std::size_t size,
               std::int64_t received_us, const drivers::LcmSender& sender = {});
  void frame(int bus, const drivers::CanFrame& frame);
  /// Must be called at least ten times a second.
  void tick(std::int64_t now_us);

  // Each returns an empty string, or the reason why it was refused.
  /// Arms when the request has a trigger, otherwise starts at once. user: sender of the command;
  /// may be empty.
  std::string begin(const SessionRequest& request, std::int64_t now_us,
                    const std::string& user = {});
  std::string tap();
  /// Ends the session half a second later, or the tap test, or disarms.
  std::string stop(const std::string& why, std::int64_t now_us);
  /// Executes a user's command, once per id. The answer is in status().
  void obey(const session_command_t& command, const std::string& user, std::int64_t now_us);

  RecorderState state() const { return state_; }
  bool checked() const { return !check_results_.empty(); }  ///< the channels have been checked
  /// Returns the seconds of samples that the running check has seen.
  double checked_s() const { return check_.seconds(); }
  /// Returns the results of the newest check, or of the running session.
  std::vector<ChannelResult> channel_results() const;
  const std::string& news() const { return news_; }
  session_status_t status(std::int64_t now_us) const;
  /// Takes the outcome of finishing a session: the name of its folder if it has a report, and a
  /// sentence for the user.
  void finished(const std::string& report, const std::string& news);

 private:
  void store(KeptMessage message);
  void sample(const estimator::AccelSample& sample);
  void keep(const estimator::SampleSet& set);
  void detect_tap(const std::vector<double>& distance);
  void detect_trigger(const std::vector<double>& distance);
  std::string open(std::int64_t now_us, const std::string& triggered_by);
  void close();
  void check_disk(std::int64_t now_us);
  void write_session_file();
  std::int64_t lost() const;

  const Config& config_;
  std::string sessions_;
  Ended ended_;
  estimator::Acquisition acquisition_;
  drivers::AccelIntake intake_;
  drivers::CanIntake can_;
  RestLevel rest_;
  ChannelCheck check_;
  TapTest taps_;
  std::vector<std::size_t> trigger_axes_;
  MessageRing before_;
  std::map<std::string, KeptMessage> tables_;  ///< the newest of each channel

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
