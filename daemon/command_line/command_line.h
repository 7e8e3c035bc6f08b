// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace framewatch::daemon {

class CommandList;

/// A program with commands.
struct Program {
  std::string name;         ///< name in messages: framewatch, or framewatch fleet
  std::string description;  ///< first text of --help
  std::string footer;       ///< last text of --help
  std::vector<void (*)(CommandList&)>
      commands;  ///< functions that add the commands, in the order of --help
  std::vector<std::string>
      services;  ///< names of the commands that systemd restarts after a failure
};

/// Does what the command line asks for and returns the exit status of the program: that of the
/// chosen command, 0 for --help and --version, 2 for bad usage.
int run_program(const Program& program, int argc, const char* const* argv);

/// Does the same for the program `framewatch`.
int run_command_line(int argc, const char* const* argv);

}  // namespace framewatch::daemon
