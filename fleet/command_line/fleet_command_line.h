// SPDX-License-Identifier: MIT
#pragma once

namespace framewatch::fleet {

/// Runs `framewatch fleet ...` and `framewatch uplink`. Returns the exit status.
int run_fleet_command_line(int argc, const char* const* argv);

}  // namespace framewatch::fleet
