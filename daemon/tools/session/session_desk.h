// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <framewatch/session_command_t.hpp>

#include "daemon/base/log.h"
#include "daemon/config/config.h"
#include "daemon/monitor/service/command_socket.h"
#include "daemon/tools/session/recorder.h"

namespace framewatch::daemon {

/// Takes commands for a recorder (session_command_t): over its socket, and from LCM where
/// lcm.commands allows it.
class SessionDesk {
 public:
  /// Both must outlive this.
  SessionDesk(const Config& config, Recorder& recorder);

  /// The LCM channel whose messages the caller passes to heard().
  const std::string& channel() const { return channel_; }
  /// Takes a command that arrived over LCM. Counts and logs a command that lcm.commands forbids.
  void heard(const void* data, std::size_t size, std::int64_t now_us);
  std::int64_t not_obeyed() const { return not_obeyed_; }

  /// Serves the socket. Call it several times a second.
  void poll();

 private:
  CommandPacket obey(const CommandPacket& command, const std::string& user);

  const Config& config_;
  const std::string channel_;
  Recorder& recorder_;
  CommandSocket socket_;
  std::int64_t not_obeyed_ = 0;
  RateLimitedLog warnings_{LogLevel::warning};
};

/// Returns a command with a unique id.
session_command_t session_command(const std::string& verb, const SessionRequest& request);

/// Sends a command to the running recorder. Returns the exit code: kFailed when the recorder
/// refuses or does not answer.
int send_session_command(const Config& config, const std::string& verb,
                         const SessionRequest& request);

}  // namespace framewatch::daemon
