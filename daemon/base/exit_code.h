// What a command returns to the shell: 0 when all was well.
#pragma once

#include <string>

namespace framewatch::daemon {

inline constexpr int kFailed = 1;    ///< it was done, and something is not well
inline constexpr int kBadInput = 2;  ///< not done: arguments or input that do not serve

/// Prints to standard error why "framewatch `command`" does nothing. Returns kBadInput.
int refuse(const std::string& command, const std::string& message);

}  // namespace framewatch::daemon
