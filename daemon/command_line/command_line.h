#pragma once

namespace framewatch::daemon {

/// Does what the command line asks for and returns the exit status of the program: that of the
/// chosen command, 0 for --help and --version, 2 for bad usage.
int run_command_line(int argc, const char* const* argv);

}  // namespace framewatch::daemon
