#pragma once

#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "estimator/diagnose/fit/diagnosis_input.h"

namespace framewatch::daemon {

/// One record of a diagnosis and the file it is from.
struct DiagnoseRecord {
  std::string path;
  std::string sha256;
  estimator::RecordSamples samples;
};

/// The records of record files or LCM event logs, in their order. Adds every problem ("place:
/// rule") of a missing channel, missing samples, a record that is too short or the same file given
/// twice; the records are then incomplete.
std::vector<DiagnoseRecord> read_diagnose_records(const Config& config,
                                                  const std::vector<std::string>& paths,
                                                  const estimator::ComponentTest& component,
                                                  std::vector<std::string>& problems);

/// The stored samples of a gap event as two records: the first for training, the second held out.
/// event: its id.
std::vector<DiagnoseRecord> read_event_records(const Config& config, const std::string& event,
                                               std::vector<std::string>& problems);

}  // namespace framewatch::daemon
