#pragma once

#include <string>
#include <vector>

namespace framewatch::daemon {

class CommandList;

/// A program that does what one of its commands says.
struct Program {
  std::string name;         ///< as it is called: framewatch, or framewatch fleet
  std::string description;  ///< what --help begins with
  std::string footer;       ///< what it ends with
  std::vector<void (*)(CommandList&)> commands;  ///< in the order in which --help lists them
  std::vector<std::string> services;  ///< names of those that systemd starts again after a failure
};

/// Does what the command line asks for and returns the exit status of the program: that of the
/// chosen command, 0 for --help and --version, 2 for bad usage.
int run_program(const Program& program, int argc, const char* const* argv);

/// Does the same for the program `framewatch`.
int run_command_line(int argc, const char* const* argv);

}  // namespace framewatch::daemon
