#pragma once

#include <cstdint>
#include <string>

#include <framewatch/acknowledge_t.hpp>

#include "daemon/status_command.h"

namespace framewatch::daemon {

struct AcknowledgeArguments {
  std::string event;  ///< its number, or "all"
  std::string config = kInstalledConfig;
  std::string url;  ///< LCM provider; empty: the configuration's
  std::string who;  ///< empty: the user's name
  std::string comment;
};

/// A request with an id that no other has. id 0: every event.
acknowledge_t acknowledge_request(std::int64_t id, const std::string& who,
                                  const std::string& comment);

/// `framewatch acknowledge`: tells the running daemon, until it answers, that somebody knows of an
/// event. Exit code: 1 when the event is not raised, 2 when none answers, or bad configuration.
int acknowledge_command(const AcknowledgeArguments& arguments);

}  // namespace framewatch::daemon
