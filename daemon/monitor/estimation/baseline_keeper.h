// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "daemon/config/config.h"
#include "daemon/monitor/estimation/estimation.h"

namespace framewatch::daemon {

/// Adds newly learned parameters of the baseline to the configured file and logs that. Does not
/// change values that the file already has.
class BaselineKeeper {
 public:
  explicit BaselineKeeper(const Config& config);
  /// Writes new parameters of the estimation's baseline, if there are any.
  void update(const Estimation& estimation);

 private:
  estimator::ParameterTable table_;
  std::string path_;  ///< empty: no file is configured
  estimator::Baseline written_;
};

}  // namespace framewatch::daemon
