#pragma once

#include <string>

#include "daemon/status_command.h"

namespace framewatch::daemon {

struct TellArguments {
  std::string config = kInstalledConfig;
  std::string message = "a test";
};

/// `framewatch tell`: the command and the webhook of [actions] are told of an event of kind "test",
/// here and now. Exit code: 1 when one of them fails.
int tell_command(const TellArguments& arguments);

}  // namespace framewatch::daemon
