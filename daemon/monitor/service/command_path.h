#pragma once

#include <string>
#include <vector>

#include "daemon/config/sections/settings.h"

namespace framewatch::daemon {

/// Where a daemon started by this process' user listens for commands: [commands] directory, or the
/// RuntimeDirectory of its systemd unit, or a directory of the user's own.
std::string command_directory(const Config& config);

/// Where its clients look for it, in this order.
std::vector<std::string> command_directories(const Config& config);

/// Makes the directory where it is missing. Empty, or why nobody should listen there: it must be a
/// directory, no link, of this user or root, that nobody else can put files into.
std::string prepare_command_directory(const std::string& directory);

/// Of the socket of "run" or "record" in a directory: two daemons with different prefixes have two.
std::string command_path(const std::string& directory, const Config& config,
                         const std::string& service);

}  // namespace framewatch::daemon
