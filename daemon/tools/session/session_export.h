#pragma once

#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/tools/report/session_motion.h"

namespace framewatch::daemon {

// Other forms of a session's logs, beside them. What is written is added to `files`, what cannot be
// to `problems`, a sentence each.

/// Raw samples as they came, raw.csv or raw.mat (`channel`, `time_s`, `accel_mps2`: instants x
/// channels, NaN where missing); raw.ACCEL2.csv for a second LCM channel.
void export_raw(const std::string& folder, bool csv, bool mat, std::vector<std::string>& files,
                std::vector<std::string>& problems);

/// estimates.csv and estimates.mat, of the main window.
void export_estimates(const Config& config, const std::string& folder, const std::string& log,
                      bool csv, bool mat, std::vector<std::string>& files,
                      std::vector<std::string>& problems);

/// Cuts the raw log at the borders of the stages: stage-1-quiet.lcmlog, stage-2-forced.lcmlog and
/// so on.
void export_stages(const std::string& folder, const std::vector<Stage>& stages,
                   std::vector<std::string>& files, std::vector<std::string>& problems);

}  // namespace framewatch::daemon
