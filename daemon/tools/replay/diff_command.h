// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace framewatch::daemon {

struct DiffArguments {
  std::string a, b;  ///< logs with estimates
  bool json = false;
  bool quiet = false;
};

/// Runs `framewatch diff`. Returns the exit code: 0 when the estimates of both logs are identical,
/// 1 when they differ, kBadInput when a log cannot be read or has no estimate.
int diff(const DiffArguments& arguments);

}  // namespace framewatch::daemon
