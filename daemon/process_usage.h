#pragma once

#include <cstdint>
#include <string>

namespace framewatch::daemon {

/// What this process takes.
struct ProcessUsage {
  std::int64_t resident_bytes = 0;
  double cpu_s = 0;  ///< since its start, system included
};
ProcessUsage process_usage();

/// Free for this process where `path` is, or would be, its folders too; -1 when it is not known.
std::int64_t disk_free_bytes(const std::string& path);

}  // namespace framewatch::daemon
