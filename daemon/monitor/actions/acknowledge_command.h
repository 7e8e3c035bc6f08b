#pragma once

#include <string>

#include "daemon/monitor/service/installed_config.h"

namespace framewatch::daemon {

struct AcknowledgeArguments {
  std::string event;  ///< its number, or "all"
  std::string config = kInstalledConfig;
  std::string who;  ///< a remark beside the user's name, which the daemon knows; empty: none
  std::string comment;
};

/// `framewatch acknowledge`: tells the running daemon over its socket to acknowledge an event.
/// Exit code: 1 when the event is not raised, 2 without an answer or with a bad configuration.
int acknowledge_command(const AcknowledgeArguments& arguments);

}  // namespace framewatch::daemon
