#include "drivers/files/partial_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstring>
#include <filesystem>

#include "drivers/files/standard_streams.h"

namespace framewatch::drivers {
namespace {

constexpr int kTries = 3;
constexpr mode_t kMode = 0666;  // less what umask takes

/// The names of the files that are open, where a signal handler can read them.
struct Mark {
  std::atomic<bool> taken{false}, complete{false};
  std::array<char, PATH_MAX> path{};
};
std::array<Mark, 64> marks;

/// -1: there is no place, and a signal leaves the file behind.
int marked(const std::string& path) {
  if (path.size() >= PATH_MAX) return -1;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    if (marks[i].taken.exchange(true)) continue;
    std::copy_n(path.c_str(), path.size() + 1, marks[i].path.begin());
    marks[i].complete = true;
    return static_cast<int>(i);
  }
  return -1;
}

void unmark(int at) {
  if (at < 0) return;
  Mark& mark = marks[static_cast<std::size_t>(at)];
  mark.complete = false;
  mark.taken = false;
}

/// No signal comes to this thread between a file's making and its mark.
class WithoutSignals {
 public:
  WithoutSignals() {
    sigset_t all;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_BLOCK, &all, &before_);
  }
  ~WithoutSignals() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  WithoutSignals(const WithoutSignals&) = delete;
  WithoutSignals& operator=(const WithoutSignals&) = delete;

 private:
  sigset_t before_{};
};

/// Why what is there under the name of a partial file cannot be removed; empty: it is gone.
std::string clear_away(const std::string& partial) {
  struct stat there {};
  if (::lstat(partial.c_str(), &there) != 0) return errno == ENOENT ? "" : std::strerror(errno);
  if (S_ISLNK(there.st_mode)) return "is a symbolic link, not a file that a run left behind";
  if (!S_ISREG(there.st_mode)) return "is there and no plain file";
  if (there.st_uid != ::geteuid()) return "is there and belongs to another user";
  const int file = ::open(partial.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  const bool writing = file >= 0 && ::flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  if (file >= 0) ::close(file);
  if (writing) return "is being written by another process";
  return ::unlink(partial.c_str()) == 0 || errno == ENOENT ? "" : std::strerror(errno);
}

}  // namespace

PartialFile::~PartialFile() {
  discard();
}

bool PartialFile::fail(const std::string& why) {
  if (error_.empty()) error_ = why;
  return false;
}

bool PartialFile::make(const std::string& partial) {
  for (int i = 0; i < kTries; ++i) {
    file_ = ::open(partial.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, kMode);
    if (file_ < 0 && errno != EEXIST) return fail(std::strerror(errno));
    if (file_ < 0) {
      if (const std::string why = clear_away(partial); !why.empty())
        return fail(partial + " " + why);
      continue;
    }
    ::flock(file_, LOCK_EX | LOCK_NB);
    if (still_ours()) return true;  // nobody took it for one that was left behind
    ::close(file_);
    file_ = -1;
  }
  return fail(partial + " is made by somebody else again and again");
}

bool PartialFile::still_ours() const {
  struct stat named {
  }, open{};
  return ::lstat((path_ + ".partial").c_str(), &named) == 0 && ::fstat(file_, &open) == 0 &&
         named.st_ino == open.st_ino && named.st_dev == open.st_dev;
}

bool PartialFile::open_standard_output() {
  static std::atomic<bool> taken{false};
  if (taken.exchange(true)) return fail("only one output can go to standard output");
  file_ = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0);
  return file_ >= 0 || fail(std::strerror(errno));
}

bool PartialFile::open(const std::string& path) {
  discard();
  path_ = path;
  error_.clear();
  is_standard_output_ = path == kStandardOutput;
  if (is_standard_output_) return open_standard_output();
  struct stat there {};
  if (::stat(path.c_str(), &there) == 0 && !S_ISREG(there.st_mode))
    return fail(S_ISDIR(there.st_mode) ? "is a directory" : "is there and no plain file");
  const WithoutSignals undisturbed;
  if (!make(path + ".partial")) return false;
  mark_ = marked(path + ".partial");
  return true;
}

std::FILE* PartialFile::stream() {
  const int copy = ::fcntl(file_, F_DUPFD_CLOEXEC, 0);
  std::FILE* const out = copy < 0 ? nullptr : ::fdopen(copy, "wb");
  if (out != nullptr) return out;
  fail(std::strerror(errno));
  if (copy >= 0) ::close(copy);
  return nullptr;
}

bool PartialFile::commit() {
  if (file_ < 0) return fail("is not open");
  if (is_standard_output_) {
    if (::close(file_) != 0) fail(std::strerror(errno));
    file_ = -1;
    return error_.empty();
  }
  const std::string partial = path_ + ".partial";
  // A file system that cannot force anything onto a disk says EINVAL.
  if (::fsync(file_) != 0 && errno != EINVAL) fail(std::strerror(errno));
  if (error_.empty() && !still_ours()) {
    fail(partial + " was replaced while it was written");
    unmark(mark_);
    mark_ = -1;
    ::close(file_);
    file_ = -1;
    return false;
  }
  if (error_.empty() && std::rename(partial.c_str(), path_.c_str()) != 0)
    fail(std::strerror(errno));
  if (!error_.empty()) {
    discard();
    return false;
  }
  unmark(mark_);
  mark_ = -1;
  ::close(file_);
  file_ = -1;
  sync_folder_of(path_);
  return true;
}

void PartialFile::discard() {
  if (file_ < 0) return;
  if (!is_standard_output_ && still_ours()) ::unlink((path_ + ".partial").c_str());
  unmark(mark_);
  mark_ = -1;
  ::close(file_);
  file_ = -1;
}

void sync_folder_of(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const int file = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return;
  ::fsync(file);
  ::close(file);
}

int open_own_file(const std::string& path, int flags, mode_t mode) {
  const int file = ::open(path.c_str(), flags | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, mode);
  struct stat found {};
  if (file < 0 || (::fstat(file, &found) == 0 && S_ISREG(found.st_mode))) return file;
  ::close(file);
  errno = EINVAL;
  return -1;
}

void remove_partial_files() {
  const int before = errno;
  const auto say = [](const char* text) { return ::write(STDERR_FILENO, text, std::strlen(text)); };
  for (Mark& mark : marks) {
    if (!mark.complete || ::unlink(mark.path.data()) != 0) continue;
    if (say("framewatch: ends; ") >= 0 && say(mark.path.data()) >= 0) (void)say(" is removed\n");
  }
  errno = before;
}

}  // namespace framewatch::drivers
