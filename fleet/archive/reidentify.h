#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "fleet/archive/archive_task.h"

namespace framewatch::fleet {

/// What became of a task.
struct Reidentified {
  std::string problem;             ///< why there is no output; empty: there is
  std::vector<std::string> notes;  ///< damage and what else the reader should know
  int passes = 1;                  ///< over the logs: tuned on first, then estimated
  std::int64_t windows = 0;        ///< that were published, those of the warm-up too
  std::int64_t instants = 0;       ///< of the common grid
  std::int64_t damaged_bytes = 0;
  double measured_s = 0;  ///< sensor time that was read
};

/// Runs the logs of a task through an estimation into `path`, a database with the tables of a
/// history, of the task's time alone. Whatever is intact of a damaged log is used.
Reidentified reidentify(const daemon::Config& config, const ArchiveTask& task,
                        const std::string& path);

}  // namespace framewatch::fleet
