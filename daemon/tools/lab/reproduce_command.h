// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace framewatch::daemon {

struct ReproduceArguments {
  std::string only;  ///< one case; empty: all
  std::string out;   ///< folder; created if missing
  int seeds = 20;
  int threads = 0;  ///< 0: one per core
  bool quiet = false;
};

/// Runs `framewatch reproduce`. Returns the exit code: 0 written and every promise kept, 1 written
/// and a promise broken, 2 bad usage or the output cannot be written.
int reproduce(const ReproduceArguments& arguments);

}  // namespace framewatch::daemon
