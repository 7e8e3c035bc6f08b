#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "daemon/config.h"
#include "daemon/diagnose_command.h"

namespace framewatch::daemon {

/// One record of a diagnosis: all axes of the configuration, calibrated.
struct DiagnoseRecord {
  std::string path;
  std::string sha256;
  double rate_hz = 0;
  Eigen::MatrixXd accel;  ///< instants x axes, m/s^2, finite
};

/// Reads a record file or an LCM event log. Empty with every problem ("place: rule") when a channel
/// is missing, when samples are, or when it is too short.
std::optional<DiagnoseRecord> read_diagnose_record(const Config& config, const std::string& path,
                                                   const ComponentTest& component,
                                                   std::vector<std::string>& problems);

}  // namespace framewatch::daemon
