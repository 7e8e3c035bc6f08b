#pragma once

#include <string>

#include <framewatch/session_command_t.hpp>

#include "daemon/config/config.h"
#include "daemon/tools/report/session_file.h"

namespace framewatch::daemon {

/// A command with a unique id.
session_command_t session_command(const std::string& verb, const SessionRequest& request);

/// Gives a command to the running recorder. Exit code: 1 when it refuses, or when none answers.
int send_session_command(const Config& config, const std::string& verb,
                         const SessionRequest& request);

}  // namespace framewatch::daemon
