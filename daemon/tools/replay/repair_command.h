#pragma once

#include <string>

namespace framewatch::daemon {

struct RepairArguments {
  std::string log;
  std::string out;     ///< empty: beside the log
  bool check = false;  ///< write nothing
  bool json = false;
};

/// framewatch repair. Exit code.
int repair(const RepairArguments& arguments);

}  // namespace framewatch::daemon
