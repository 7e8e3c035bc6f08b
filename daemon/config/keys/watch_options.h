// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "estimator/gap/gap.h"
#include "estimator/watch/watch.h"
#include "estimator/years/life_budget.h"

namespace framewatch::daemon {

/// [gap]: the building is simulated and compared with its measurement.
struct GapSettings {
  estimator::GapOptions options;
  std::string model_path;                    ///< empty if the model is learned
  std::optional<estimator::GapModel> model;  ///< content of that file, if it exists
  std::string store;                         ///< directory of the segments; empty to store none
  double before_s = 30, after_s = 60;
};

/// [watch]: stiffness is watched for lasting changes.
struct WatchSettings {
  estimator::WatchOptions options;
  std::string baseline_path;                    ///< empty for no file
  std::string temperature_channel;              ///< LCM channel of temperature_t; empty for none
  estimator::LifeBudget life;                   ///< of lasting losses in daily means
  std::optional<estimator::Baseline> baseline;  ///< content of that file, if it exists
};

}  // namespace framewatch::daemon
