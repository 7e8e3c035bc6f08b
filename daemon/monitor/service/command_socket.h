// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <future>
#include <list>
#include <string>
#include <vector>

#include "daemon/config/sections/settings.h"
#include "daemon/monitor/service/command_client.h"
#include "drivers/files/descriptor.h"

namespace framewatch::daemon {

/// Takes commands over a Unix socket (SOCK_SEQPACKET, mode 0660): one packet and one answer per
/// connection. File permissions decide who may connect; the kernel names the user. Never blocks.
class CommandSocket {
 public:
  static constexpr std::size_t kMaxConnections =
      16;  ///< if there are more, the oldest silent one is closed
  static constexpr std::int64_t kPatience_us = 3'000'000;  ///< wait for a silent connection

  /// Returns the answer to a command of `user`.
  using Handler =
      std::function<CommandPacket(const CommandPacket& command, const std::string& user)>;

  /// Starts to listen. If that fails, the log says why and poll() tries again. `service` is "run"
  /// or "record".
  CommandSocket(const Config& config, const std::string& service, Handler handler);
  ~CommandSocket();

  /// Accepts connections, reads commands and sends answers. Call it several times a second;
  /// `now_us`: steady clock.
  void poll(std::int64_t now_us);

  /// Returns why the socket does not listen; empty if it does.
  const std::string& problem() const { return problem_; }
  const std::string& path() const { return path_; }
  std::int64_t malformed() const { return malformed_; }  ///< malformed packets so far

 private:
  struct Connection {
    drivers::Descriptor file;
    uid_t user = 0;
    std::int64_t until_us = 0;
    CommandPacket command;          ///< empty channel: not received yet
    std::future<std::string> name;  ///< of the user, requested when the command is received
  };
  enum class Next { wait, done };

  void listen(std::int64_t now_us);
  std::string open();
  void accept(std::int64_t now_us);
  bool make_room();
  Next receive(Connection& connection, std::int64_t now_us);
  Next answer(Connection& connection);

  std::string directory_, path_, service_;
  Handler handler_;
  drivers::Descriptor lock_, socket_;
  std::string problem_ = "not tried yet";
  std::int64_t next_try_us_ = INT64_MIN, malformed_ = 0;
  std::list<Connection> connections_;
  std::vector<std::uint8_t> buffer_;
};

}  // namespace framewatch::daemon
