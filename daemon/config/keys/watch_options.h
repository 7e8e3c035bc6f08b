#pragma once

#include <optional>
#include <string>

#include "estimator/gap/gap.h"
#include "estimator/watch/watch.h"

namespace framewatch::daemon {

/// [gap]: the building is simulated beside its measurement.
struct GapSettings {
  estimator::GapOptions options;
  std::string model_path;                    ///< empty: the model is learned
  std::optional<estimator::GapModel> model;  ///< of that file, if there is one yet
  std::string store;                         ///< directory of the segments; empty: none are stored
  double before_s = 30, after_s = 60;
};

/// [watch]: stiffness is watched for lasting changes.
struct WatchSettings {
  estimator::WatchOptions options;
  std::string baseline_path;                    ///< empty: none
  std::string temperature_channel;              ///< LCM channel of temperature_t; empty: none
  std::optional<estimator::Baseline> baseline;  ///< of that file, if there is one yet
};

}  // namespace framewatch::daemon
