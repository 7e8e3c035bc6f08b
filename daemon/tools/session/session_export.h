// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/tools/report/session_motion.h"

namespace framewatch::daemon {

// These write other forms of a session's logs into its folder. They add the files written to
// `files`, and a sentence for each failure to `problems`.

/// Writes the raw samples as received to raw.csv and raw.mat (`channel`, `time_s`, `accel_mps2`:
/// instants x channels, NaN where missing). A second LCM channel gets raw.ACCEL2.csv.
void export_raw(const std::string& folder, bool csv, bool mat, std::vector<std::string>& files,
                std::vector<std::string>& problems);

/// Writes the estimates of the main window to estimates.csv and estimates.mat.
void export_estimates(const Config& config, const std::string& folder, const std::string& log,
                      bool csv, bool mat, std::vector<std::string>& files,
                      std::vector<std::string>& problems);

/// Cuts the raw log at the borders of the stages into stage-1-quiet.lcmlog, stage-2-forced.lcmlog
/// and so on.
void export_stages(const std::string& folder, const std::vector<Stage>& stages,
                   std::vector<std::string>& files, std::vector<std::string>& problems);

}  // namespace framewatch::daemon
