#pragma once

namespace framewatch::fleet {

/// What `framewatch fleet ...` and `framewatch uplink` do; returns the exit status of the program.
int run_fleet_command_line(int argc, const char* const* argv);

}  // namespace framewatch::fleet
