#pragma once

#include <string>

namespace framewatch::daemon {

struct ReproduceArguments {
  std::string only;  ///< one case; empty: all
  std::string out;   ///< folder, made when it is not there
  int seeds = 20;
  int threads = 0;  ///< 0: one per core
  bool quiet = false;
};

/// framewatch reproduce. Exit code: 0 written and every promise kept, 1 written and one not kept, 2
/// bad usage or nowhere to write.
int reproduce(const ReproduceArguments& arguments);

}  // namespace framewatch::daemon
