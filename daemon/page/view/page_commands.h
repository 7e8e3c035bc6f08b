// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

#include "daemon/monitor/service/command_client.h"

namespace framewatch::daemon {

/// A command that a viewer of the page gives.
struct PageCommand {
  std::string service;  ///< "run" or "record"
  CommandPacket packet;
  std::int64_t id = 0;  ///< of the request
};

/// Sends the commands of viewers to the daemons, one at a time, in a separate thread, so that a
/// daemon that does not answer delays nothing but commands.
class PageCommands {
 public:
  static constexpr std::size_t kMax = 16;  ///< waiting commands

  using Give = std::function<CommandAnswer(const std::string& service, const CommandPacket&)>;
  /// Called in that thread when the command failed.
  using Failed = std::function<void(const PageCommand&, const std::string& problem)>;

  PageCommands(Give give, Failed failed);

  /// Queues a command. Returns false when kMax commands wait.
  bool add(PageCommand command);

 private:
  void work(const std::stop_token& stop);

  Give give_;
  Failed failed_;
  std::mutex mutex_;
  std::condition_variable_any news_;
  std::deque<PageCommand> waiting_;
  std::jthread thread_;  ///< last: it uses the members above. At the end it finishes its command
};

}  // namespace framewatch::daemon
