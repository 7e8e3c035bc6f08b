// SPDX-License-Identifier: MIT
// Exit codes of commands, and the end of the program. A command returns 0 when all is well.
#pragma once

#include <functional>
#include <string>

namespace framewatch::daemon {

/// Prepares the program's end for every command. A fatal signal or an uncaught exception then
/// leaves no partial file, and closed standard streams are never reused for the program's files.
/// Call it once, before opening anything.
void prepare_last_resort();

/// Sets the command that messages of run_to_the_end() name. `service`: the service manager restarts
/// the program after a failure.
void now_runs(const std::string& command, bool service);

/// Calls `run` and returns the exit status of the program, which is the result of `run`. Prints an
/// uncaught exception, also of a thread, on stderr with the name of the command and returns
/// kBadInput, or kFailed for a service. Prints that standard output could not be written and
/// returns kBadInput.
int run_to_the_end(const std::function<int()>& run);

inline constexpr int kFailed = 1;    ///< the command ran and found or had a failure
inline constexpr int kBadInput = 2;  ///< the command did not run: invalid arguments or input

/// Prints on stderr why "framewatch `command`" refuses to run. Returns kBadInput.
int refuse(const std::string& command, const std::string& message);

}  // namespace framewatch::daemon
