#pragma once

#include <cstdint>
#include <string>

namespace framewatch::daemon {

/// Memory and processor time that this process uses.
struct ProcessUsage {
  std::int64_t resident_bytes = 0;
  double cpu_s = 0;  ///< since its start, system included
};
ProcessUsage process_usage();

/// Bytes that this process can still write to the file system of `path`, which need not exist yet;
/// -1 when it is not known.
std::int64_t disk_free_bytes(const std::string& path);

}  // namespace framewatch::daemon
