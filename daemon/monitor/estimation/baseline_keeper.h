#pragma once

#include <string>

#include "daemon/config/config.h"
#include "daemon/monitor/estimation/estimation.h"

namespace framewatch::daemon {

/// Adds newly learned parameters of the baseline to the configured file and logs it. Values that
/// are in the file stay.
class BaselineKeeper {
 public:
  explicit BaselineKeeper(const Config& config);
  void update(const Estimation& estimation);

 private:
  estimator::ParameterTable table_;
  std::string path_;  ///< empty: there is no file
  estimator::Baseline written_;
};

}  // namespace framewatch::daemon
