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

/// A command that a person gives, as it stands in the journal.
struct CommandOrder {
  std::string request;  ///< its name, by chance
  std::string who, verb;
  std::string content;  ///< JSON
  struct Target {
    std::int64_t id = 0;  ///< in the database
    std::string name;
  };
  std::vector<Target> targets;
};

/// The words of a command as they came with a request.
struct CommandWords {
  std::string verb, from_us, to_us, channels, id, comment;
};
/// The content of the command as JSON; empty with the reason: a verb that is none, a time or an
/// event that is no number.
std::optional<std::string> command_content(const CommandWords& words, std::string& why);

/// The message to a building: docs/fleet.md. until_us: UTC, when it is void.
Message command_message(const CommandOrder& order, const std::string& building,
                        const std::string& reply, std::int64_t until_us);

/// What became of a command at one building.
struct CommandResult {
  std::string request;
  std::int64_t building = 0;  ///< in the database
  bool done = false;
  std::string answer;  ///< why not; empty: done
};

/// Sends commands to buildings and collects what they answer. Each is sent once: a building that
/// does not answer in time, or is away, is a result too.
class Commander {
 public:
  static constexpr std::size_t kMaxOrders = 64;
  static constexpr std::int64_t kWait_us = 10'000'000, kVoid_us = 30'000'000;

  /// `tell` gets each result once, on the thread of step(). Both must outlive this.
  Commander(Link& link, std::function<void(const CommandResult&)> tell);

  /// Any thread. False: too many wait.
  [[nodiscard]] bool give(CommandOrder order);
  /// To be called often. steady_us: a clock that is never set; utc_us: the host's.
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
  std::map<std::string, Waiting> waiting_;  ///< by the subject of the reply
  std::int64_t number_ = 0;
};

}  // namespace framewatch::fleet
