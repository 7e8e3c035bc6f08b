// SPDX-License-Identifier: MIT
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <string>

#include "tests/support/temporary.h"

namespace framewatch::test {

/// The result of a shell command.
struct ShellResult {
  int status = -1;  ///< exit status; -1: a signal ended it
  std::string out, err;
};

/// Runs a line of bash in `directory`; $F is the program. Standard input is empty.
inline ShellResult shell(const TemporaryDirectory& directory, const std::string& line) {
  write_file(directory.path(".line"), "F=" FRAMEWATCH_PROGRAM "\n" + line + "\n");
  const std::string command = "cd " + directory.path("") + " && bash .line </dev/null >.out 2>.err";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(directory.path(".out")),
          read_file(directory.path(".err"))};
}

}  // namespace framewatch::test
