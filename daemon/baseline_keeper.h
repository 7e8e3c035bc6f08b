#pragma once

#include <string>

#include "daemon/config.h"
#include "daemon/estimation.h"

namespace framewatch::daemon {

/// Adds to the configured file what is learned live of a baseline, when it is, and says so in the
/// log. What is in the file stays as it is.
class BaselineKeeper {
 public:
  explicit BaselineKeeper(const Config& config);
  void look(const Estimation& estimation);

 private:
  ParameterTable table_;
  std::string path_;  ///< empty: there is no file
  Baseline written_;
};

}  // namespace framewatch::daemon
