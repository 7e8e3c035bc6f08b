#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "fleet/archive/archive_task.h"

namespace framewatch::fleet {

/// A log of an archive, with the sensor time that it may hold samples of: [start_us, end_us).
struct ArchiveLog {
  std::string path;
  std::int64_t start_us = 0, end_us = 0;
  std::string sha256 = {};
};

/// The logs that `places` name, in order of time: files, and directories of a history (or their
/// folder of raw logs). Raw logs say by their names when they begin, and end with the next, where
/// that follows; other logs are read. Logs that `run` is still writing are left out. Problems are
/// added, "place: rule".
std::vector<ArchiveLog> archive_logs(const std::vector<std::string>& places,
                                     const daemon::Config& config,
                                     std::vector<std::string>& problems);

/// The digest of each, several at a time.
void add_digests(std::vector<ArchiveLog>& logs, std::vector<std::string>& problems);

struct ArchivePlan {
  std::string config, folder;  ///< of the outputs
  std::int64_t length_s = 0;   ///< of the time that a task stores
  std::int64_t warm_up_s = 0;  ///< of samples before it, which only prepare
  std::string making = {};     ///< making_of() the outputs
};

/// Tasks of equal length that begin at multiples of it, with the logs that each needs, numbered
/// from 1; none where there is no log. The first 100 000 of them.
std::vector<ArchiveTask> plan_tasks(const ArchivePlan& plan, const std::vector<ArchiveLog>& logs);

struct ManifestArguments {
  std::string config, folder;       ///< of the outputs
  std::vector<std::string> places;  ///< logs, or directories of a history
  int hours = 48;                   ///< of a task
  double warm_up_s = 3600;
};

/// framewatch fleet manifest: tasks to standard output, one a line.
int manifest(const ManifestArguments& arguments);

}  // namespace framewatch::fleet
