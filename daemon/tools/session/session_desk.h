#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "daemon/base/log.h"
#include "daemon/config/config.h"
#include "daemon/monitor/service/command_socket.h"
#include "daemon/tools/session/recorder.h"

namespace framewatch::daemon {

/// Takes commands for a recorder (session_command_t): over its socket, and from LCM where
/// lcm.commands allows that.
class SessionDesk {
 public:
  /// Both must outlive this.
  SessionDesk(const Config& config, Recorder& recorder);

  /// The LCM channel that heard() wants the messages of.
  const std::string& channel() const { return channel_; }
  /// A command that came over LCM; one that is not obeyed is counted, and a log line says so.
  void heard(const void* data, std::size_t size, std::int64_t now_us);
  std::int64_t not_obeyed() const { return not_obeyed_; }

  /// To be called several times a second.
  void look();

 private:
  CommandPacket obey(const CommandPacket& command, const std::string& user);

  const Config& config_;
  const std::string channel_;
  Recorder& recorder_;
  CommandSocket socket_;
  std::int64_t not_obeyed_ = 0;
  RateLimitedLog warnings_{LogLevel::warning};
};

}  // namespace framewatch::daemon
