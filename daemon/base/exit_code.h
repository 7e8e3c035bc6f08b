// What a command returns to the shell: 0 when all was well.
#pragma once

#include <functional>
#include <string>

namespace framewatch::daemon {

/// What holds for every command, whatever happens in it: a signal that ends the process, or an
/// exception that nothing caught, leaves no partial file behind; closed standard streams are never
/// taken for a file of ours. To be called once, before anything is opened.
void prepare_last_resort();

/// What the program is at, for the words of run_to_the_end(). A service is to be started again
/// after a failure.
void now_runs(const std::string& command, bool service);

/// Does `run`, whose result is the exit status of the program. An exception that nothing caught is
/// said on stderr with the name of the command; the status is then kBadInput, or kFailed for a
/// service. So it is when one leaves a thread. Standard output that did not take everything is said
/// as well; the status is then kBadInput.
int run_to_the_end(const std::function<int()>& run);

inline constexpr int kFailed = 1;    ///< it was done, and something is not well
inline constexpr int kBadInput = 2;  ///< not done: arguments or input that do not serve

/// Prints to standard error why "framewatch `command`" does nothing. Returns kBadInput.
int refuse(const std::string& command, const std::string& message);

}  // namespace framewatch::daemon
