#pragma once

#include <string>
#include <vector>

namespace framewatch::daemon {

struct ReplayArguments {
  std::string config;
  std::vector<std::string> inputs;  ///< LCM event logs and record files, in order of time
  std::string out;                  ///< estimates as an LCM log; empty: only the summary
  bool salvage = false;             ///< replay what is intact of damaged input
  bool quiet = false;
  bool json = false;  ///< summary as JSON
};

/// framewatch replay. Exit code.
int replay(const ReplayArguments& arguments);

}  // namespace framewatch::daemon
