#pragma once

#include <string>

#include <framewatch/session_command_t.hpp>
#include <lcm/lcm-cpp.hpp>

#include "daemon/session_file.h"

namespace framewatch::daemon {

/// A command with an id that no other has.
session_command_t session_command(const std::string& verb, const SessionRequest& request);

/// Tells the recorder that runs, until it answers. Exit code: 1 when it refuses, or none answers.
int send_session_command(lcm::LCM& lcm, const std::string& prefix, const std::string& verb,
                         const SessionRequest& request);

}  // namespace framewatch::daemon
