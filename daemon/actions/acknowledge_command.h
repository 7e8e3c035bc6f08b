#pragma once

#include <string>

#include "daemon/service/installed_config.h"

namespace framewatch::daemon {

struct AcknowledgeArguments {
  std::string event;  ///< its number, or "all"
  std::string config = kInstalledConfig;
  std::string url;  ///< LCM provider; empty: the configuration's
  std::string who;  ///< empty: the user's name
  std::string comment;
};

/// `framewatch acknowledge`: asks the running daemon, until it answers, to acknowledge an event.
/// Exit code: 1 when the event is not raised, 2 without an answer or with a bad configuration.
int acknowledge_command(const AcknowledgeArguments& arguments);

}  // namespace framewatch::daemon
