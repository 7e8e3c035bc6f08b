#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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

}  // namespace framewatch::fleet
