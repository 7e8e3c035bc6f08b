#include "daemon/monitor/history/history_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace framewatch::daemon {

HistoryLock::~HistoryLock() {
  if (file_ >= 0) ::close(file_);
}

std::string HistoryLock::take(const std::string& directory) {
  if (file_ >= 0) return {};
  const int file = ::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return std::strerror(errno);
  if (::flock(file, LOCK_EX | LOCK_NB) == 0) {
    file_ = file;
    return {};
  }
  const int why = errno;
  ::close(file);
  return why == EWOULDBLOCK ? "another program writes this history" : std::strerror(why);
}

}  // namespace framewatch::daemon
