#pragma once

#include <optional>
#include <string>

#include "estimator/watch/watch.h"

namespace framewatch::daemon {

/// [watch]: stiffness is watched for lasting changes.
struct WatchSettings {
  estimator::WatchOptions options;
  std::string baseline_path;                    ///< empty: none
  std::string temperature_channel;              ///< LCM channel of temperature_t; empty: none
  std::optional<estimator::Baseline> baseline;  ///< of that file, if there is one yet
};

}  // namespace framewatch::daemon
