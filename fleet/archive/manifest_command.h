// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "fleet/archive/archive_task.h"

namespace framewatch::fleet {

/// A log of an archive and the range of sensor time of its samples: [start_us, end_us).
struct ArchiveLog {
  std::string path;
  std::int64_t start_us = 0, end_us = 0;
  std::string sha256 = {};
};

/// Finds the logs in `places` (files, directories of a history, or folders of raw logs) in order of
/// time. A raw log starts at the time in its name and ends where the next one starts; other logs
/// are read for their times. Leaves out logs that `framewatch run` is still writing. Adds
/// "place: rule" to `problems`.
std::vector<ArchiveLog> archive_logs(const std::vector<std::string>& places,
                                     const daemon::Config& config,
                                     std::vector<std::string>& problems);

/// Computes the digest of each log, several at a time. Adds unreadable logs to `problems`.
void add_digests(std::vector<ArchiveLog>& logs, std::vector<std::string>& problems);

struct ArchivePlan {
  std::string config, folder;  ///< folder: of the outputs
  std::int64_t length_s = 0;   ///< time that a task stores
  std::int64_t warm_up_s = 0;  ///< time before it whose samples only prepare the estimator
  std::string making = {};     ///< making_of()
};

/// Plans tasks of equal length that begin at multiples of it and overlap a log, each with its logs,
/// numbered from 1. Returns at most 100 000 tasks.
std::vector<ArchiveTask> plan_tasks(const ArchivePlan& plan, const std::vector<ArchiveLog>& logs);

struct ManifestArguments {
  std::string config, folder;       ///< folder: of the outputs
  std::vector<std::string> places;  ///< logs, or directories of a history
  int hours = 48;                   ///< of a task
  double warm_up_s = 3600;
};

/// Runs `framewatch fleet manifest`: prints the tasks, one a line. Returns the exit status.
int manifest(const ManifestArguments& arguments);

}  // namespace framewatch::fleet
