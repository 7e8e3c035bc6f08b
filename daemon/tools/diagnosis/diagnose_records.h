// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "estimator/diagnose/fit/diagnosis_input.h"

namespace framewatch::daemon {

/// One record of a diagnosis and the file it was read from.
struct DiagnoseRecord {
  std::string path;
  std::string sha256;
  estimator::RecordSamples samples;
};

/// Reads record files or LCM event logs, in the order of `paths`. Adds a problem ("place: rule")
/// for each missing channel, missing samples, another rate than the configuration's, a channel that
/// repeats one of another floor, a record that is too short and a file given twice; the result is
/// then incomplete.
std::vector<DiagnoseRecord> read_diagnose_records(const Config& config,
                                                  const std::vector<std::string>& paths,
                                                  const estimator::ComponentTest& component,
                                                  std::vector<std::string>& problems);

/// Reads the stored samples of a gap event as two records: the first for training, the second held
/// out. event: its id. Returns an empty vector and adds to `problems` when they cannot be read.
std::vector<DiagnoseRecord> read_event_records(const Config& config, const std::string& event,
                                               std::vector<std::string>& problems);

/// Channels that a diagnosis uses: all except check channels, which may be on floors whose motion
/// depends on a small error of gain.
struct ComparedChannels {
  /// With the remainders of their delays below one sample: records have the whole samples removed.
  std::vector<estimator::SensorAxis> axes;
  std::vector<estimator::Effect> known;  ///< effects of the configuration, placed on these axes
};

/// Removes the columns of check channels from the records. Effects on these channels are skipped.
ComparedChannels compared_channels(const Config& config, std::vector<DiagnoseRecord>& records);

/// Adds why a record of the input cannot be diagnosed, and what to measure instead: too few
/// frequencies, motion below the sensors' noise, or channels whose clocks differ.
void add_segment_problems(const std::string& path, const estimator::DiagnosisInput& input,
                          std::size_t record, const estimator::ComponentTest& component,
                          std::vector<std::string>& problems);

}  // namespace framewatch::daemon
