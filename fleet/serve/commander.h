// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fleet/link/link.h"
#include "fleet/message/message.h"

namespace framewatch::fleet {

/// A command of a person, as stored in the journal.
struct CommandOrder {
  std::string request;  ///< random id
  std::string who, verb;
  std::string content;  ///< JSON
  struct Target {
    std::int64_t id = 0;  ///< in the database
    std::string name;
  };
  std::vector<Target> targets;
};

/// The arguments of a command in a request.
struct CommandWords {
  std::string verb, from_us, to_us, channels, id, comment;
};
/// Returns the content of the command as JSON. Returns nullopt and sets `why` if the verb is
/// unknown or a time or event is not a number.
std::optional<std::string> command_content(const CommandWords& words, std::string& why);

/// Returns the message to a building (docs/fleet.md). until_us: UTC; void afterwards.
Message command_message(const CommandOrder& order, const std::string& building,
                        const std::string& reply, std::int64_t until_us);

/// The result of a command at one building.
struct CommandResult {
  std::string request;
  std::int64_t building = 0;  ///< in the database
  bool done = false;
  std::string answer;  ///< why it was not done; empty if done
};

/// Sends commands to buildings and collects the answers. Sends each command once; a building that
/// does not answer in time yields a result too.
class Commander {
 public:
  static constexpr std::size_t kMaxOrders = 64;
  static constexpr std::int64_t kWait_us = 10'000'000, kVoid_us = 30'000'000;

  /// tell: receives each result once, in the thread of step(). Both must outlive this.
  Commander(Link& link, std::function<void(const CommandResult&)> tell);

  /// Queues a command; may be called from any thread. Returns false if kMaxOrders wait.
  [[nodiscard]] bool give(CommandOrder order);
  /// Sends queued commands and collects answers. Call it often. steady_us: monotonic clock. utc_us:
  /// host clock.
  void step(std::int64_t steady_us, std::int64_t utc_us);

 private:
  struct Waiting {
    std::string request;
    std::int64_t building = 0;
    std::int64_t until_us = 0;  ///< steady clock
  };
  void send(const CommandOrder& order, std::int64_t steady_us, std::int64_t utc_us);
  void take(const Message& message);

  Link& link_;
  std::function<void(const CommandResult&)> tell_;
  std::mutex mutex_;  ///< guards orders_
  std::deque<CommandOrder> orders_;
  std::map<std::string, Waiting> waiting_;  ///< by reply subject
  std::int64_t number_ = 0;
};

}  // namespace framewatch::fleet
