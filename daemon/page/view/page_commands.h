#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "daemon/monitor/service/command_client.h"

namespace framewatch::daemon {

/// A command of a viewer of the page.
struct PageCommand {
  std::string service;  ///< "run" or "record"
  CommandPacket packet;
  std::int64_t id = 0;  ///< of the request
};

/// Gives the commands of the page's viewers to their daemons, one after the other, in a thread of
/// its own: a daemon that does not answer delays nothing but commands.
class PageCommands {
 public:
  static constexpr std::size_t kMax = 16;  ///< that wait

  using Give = std::function<CommandAnswer(const std::string& service, const CommandPacket&)>;
  /// Called in that thread with the problem, when no daemon took the command.
  using Failed = std::function<void(const PageCommand&, const std::string& problem)>;

  PageCommands(Give give, Failed failed);
  ~PageCommands();  ///< waits for the one that is being given
  PageCommands(const PageCommands&) = delete;
  PageCommands& operator=(const PageCommands&) = delete;

  /// False when too many wait.
  bool add(PageCommand command);

 private:
  void work();

  Give give_;
  Failed failed_;
  std::mutex mutex_;
  std::condition_variable news_;
  std::deque<PageCommand> waiting_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace framewatch::daemon
