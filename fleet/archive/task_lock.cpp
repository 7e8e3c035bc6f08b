#include "fleet/archive/task_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "drivers/files/partial_file.h"

namespace framewatch::fleet {
namespace {

/// The one who had the lock has removed the file: it is another one by now, or none.
bool is_still_named(int file, const std::string& path) {
  struct stat open {
  }, named{};
  return ::fstat(file, &open) == 0 && ::lstat(path.c_str(), &named) == 0 &&
         open.st_ino == named.st_ino && open.st_dev == named.st_dev;
}

}  // namespace

TaskLock::~TaskLock() {
  if (file_ < 0) return;
  ::unlink(path_.c_str());
  ::close(file_);
}

std::string TaskLock::take(const std::string& path) {
  for (;;) {
    const int file = drivers::open_own_file(path, O_RDWR | O_CREAT);
    if (file < 0) return std::strerror(errno);
    int locked = -1;
    do locked = ::flock(file, LOCK_EX);
    while (locked != 0 && errno == EINTR);
    const int why = errno;
    if (locked == 0 && is_still_named(file, path)) {
      path_ = path;
      file_ = file;
      return {};
    }
    ::close(file);
    if (locked != 0) return std::strerror(why);
  }
}

}  // namespace framewatch::fleet
