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
  /// Of a record that begins in motion: so many instants are there for the simulation to get going.
  Eigen::Index lead = 0;
};

/// What is stored of a gap event as two records, the first to train with, the second to judge by.
std::vector<DiagnoseRecord> read_event_records(const Config& config, const std::string& event,
                                               std::vector<std::string>& problems);

/// Reads a record file or an LCM event log. Empty with every problem ("place: rule") when a channel
/// is missing, when samples are, or when it is too short.
std::optional<DiagnoseRecord> read_diagnose_record(const Config& config, const std::string& path,
                                                   const ComponentTest& component,
                                                   std::vector<std::string>& problems);

}  // namespace framewatch::daemon
