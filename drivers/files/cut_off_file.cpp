#include "drivers/files/cut_off_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>

namespace framewatch::drivers {
namespace {

constexpr int kMaxCutOff = 1000;

/// Under the first name that is free.
std::string renamed(const std::string& partial, const std::string& path) {
  for (int n = 1; n <= kMaxCutOff; ++n) {
    const std::string kept = path + ".cut-off-" + std::to_string(n);
    if (::renameat2(AT_FDCWD, partial.c_str(), AT_FDCWD, kept.c_str(), RENAME_NOREPLACE) == 0)
      return kept;
    if (errno != EEXIST) return {};
  }
  return {};
}

}  // namespace

std::string keep_cut_off(const std::string& path) {
  const std::string partial = path + ".partial";
  const int file = ::open(partial.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) return {};
  struct stat there {};
  const bool ours = ::fstat(file, &there) == 0 && S_ISREG(there.st_mode) &&
                    there.st_uid == ::geteuid() && there.st_size > 0 &&
                    ::flock(file, LOCK_EX | LOCK_NB) == 0;
  std::string kept;
  if (ours) kept = renamed(partial, path);
  ::close(file);
  return kept;
}

}  // namespace framewatch::drivers
