#include "daemon/base/process_usage.h"

#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace framewatch::daemon {

ProcessUsage process_usage() {
  ProcessUsage usage;
  std::int64_t pages = 0, resident = 0;
  if (std::ifstream("/proc/self/statm") >> pages >> resident)
    usage.resident_bytes = resident * ::sysconf(_SC_PAGESIZE);
  rusage used{};
  ::getrusage(RUSAGE_SELF, &used);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  usage.cpu_s = seconds(used.ru_utime) + seconds(used.ru_stime);
  return usage;
}

std::int64_t disk_free_bytes(const std::string& path) {
  std::error_code problem;
  std::filesystem::path at = std::filesystem::absolute(path, problem);
  while (!std::filesystem::exists(at, problem) && at != at.parent_path()) at = at.parent_path();
  const auto space = std::filesystem::space(at, problem);
  return problem ? -1 : static_cast<std::int64_t>(space.available);
}

}  // namespace framewatch::daemon
