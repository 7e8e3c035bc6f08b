#pragma once

#include <string>

#include <framewatch/session_command_t.hpp>
#include <lcm/lcm-cpp.hpp>

#include "daemon/session/session_file.h"

namespace framewatch::daemon {

/// A command with a unique id.
session_command_t session_command(const std::string& verb, const SessionRequest& request);

/// Sends a command to the running recorder until it answers. Exit code: 1 when it refuses, or when
/// no recorder answers.
int send_session_command(lcm::LCM& lcm, const std::string& prefix, const std::string& verb,
                         const SessionRequest& request);

}  // namespace framewatch::daemon
