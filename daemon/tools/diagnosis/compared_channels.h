#pragma once

#include <vector>

#include "daemon/config/config.h"
#include "daemon/tools/diagnosis/diagnose_records.h"

namespace framewatch::daemon {

/// The channels that a diagnosis is made from: all but those for a check, which may be of floors
/// whose motion a small error of gain would decide.
struct ComparedChannels {
  /// With the rest of their delays, which is less than a sample: records have no more of them.
  std::vector<estimator::SensorAxis> axes;
  std::vector<estimator::Effect> known;  ///< of the configuration, places by these axes
};

/// Takes the columns of the other channels out of the records. Effects of other channels are left
/// out.
ComparedChannels compared_channels(const Config& config, std::vector<DiagnoseRecord>& records);

}  // namespace framewatch::daemon
