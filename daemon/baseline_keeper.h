#pragma once

#include <string>

#include "daemon/config.h"
#include "daemon/estimation.h"

namespace framewatch::daemon {

/// Writes a baseline that was learned live to the configured file, once, and says so in the log.
class BaselineKeeper {
 public:
  explicit BaselineKeeper(const Config& config);
  void look(const Estimation& estimation);

 private:
  ParameterTable table_;
  std::string path_;  ///< empty: nothing to write, or written
};

}  // namespace framewatch::daemon
