#pragma once

#include <string>

namespace framewatch::daemon {

struct DiffArguments {
  std::string a, b;  ///< logs with estimates
  bool json = false;
  bool quiet = false;
};

/// framewatch diff. Exit code.
int diff(const DiffArguments& arguments);

}  // namespace framewatch::daemon
