// SPDX-License-Identifier: MIT
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

#include "drivers/files/descriptor.h"
#include "drivers/files/standard_streams.h"

namespace framewatch::drivers {
namespace {

constexpr int kTries = 3;
constexpr mode_t kMode = 0666;  // minus the bits of umask

/// The names of the files that are open, where a signal handler can read them.
struct Mark {
  std::atomic<bool> taken{false}, complete{false};
  std::array<char, PATH_MAX> path{};
};
std::array<Mark, 64> marks;

/// Returns the place of the new mark, or -1 when there is no room: a signal then leaves the file
/// behind.
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

/// Blocks signals in this thread, so that none comes between the creation of a file and its mark.
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

/// Removes an old partial file. Returns an empty string, or why it cannot be removed.
std::string clear_away(const std::string& partial) {
  struct stat there {};
  if (::lstat(partial.c_str(), &there) != 0) return errno == ENOENT ? "" : std::strerror(errno);
  if (S_ISLNK(there.st_mode))
    return "is a symbolic link, not a file that an earlier run left behind";
  if (!S_ISREG(there.st_mode)) return "exists and is not a regular file";
  if (there.st_uid != ::geteuid()) return "exists and belongs to another user";
  const int file = ::open(partial.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  const bool writing = file >= 0 && ::flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  if (file >= 0) ::close(file);
  if (writing) return "is being written by another process";
  return ::unlink(partial.c_str()) == 0 || errno == ENOENT ? "" : std::strerror(errno);
}

constexpr int kMaxCutOff = 1000;

/// Renames a partial file to the first free name and returns that; empty when the system refuses.
std::string rename_cut_off(const std::string& partial, const std::string& path) {
  for (int n = 1; n <= kMaxCutOff; ++n) {
    const std::string kept = path + ".cut-off-" + std::to_string(n);
    if (::renameat2(AT_FDCWD, partial.c_str(), AT_FDCWD, kept.c_str(), RENAME_NOREPLACE) == 0)
      return kept;
    if (errno != EEXIST) return {};
  }
  return {};
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
    if (still_ours()) return true;  // no other process removed it as one left behind
    ::close(file_);
    file_ = -1;
  }
  return fail(partial + " is repeatedly created by another process");
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
    return fail(S_ISDIR(there.st_mode) ? "is a directory" : "exists and is not a regular file");
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
  // EINVAL: this file system has no fsync.
  if (::fsync(file_) != 0 && errno != EINVAL) fail(std::strerror(errno));
  if (error_.empty() && !still_ours()) {
    fail(partial + " was replaced while it was written");
    close();
    return false;
  }
  if (error_.empty() && std::rename(partial.c_str(), path_.c_str()) != 0)
    fail(std::strerror(errno));
  if (!error_.empty()) {
    discard();
    return false;
  }
  close();
  sync_folder_of(path_);
  return true;
}

void PartialFile::discard() {
  if (file_ < 0) return;
  if (!is_standard_output_ && still_ours()) ::unlink((path_ + ".partial").c_str());
  close();
}

void PartialFile::close() {
  unmark(mark_);
  mark_ = -1;
  ::close(file_);
  file_ = -1;
}

void sync_folder_of(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const Descriptor file(::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.get() >= 0) ::fsync(file.get());
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
    if (say("framewatch: stopping; removed ") >= 0 && say(mark.path.data()) >= 0) (void)say("\n");
  }
  errno = before;
}

std::string keep_cut_off(const std::string& path) {
  const std::string partial = path + ".partial";
  const Descriptor file(::open(partial.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  struct stat there {};
  const bool ours = file.get() >= 0 && ::fstat(file.get(), &there) == 0 && S_ISREG(there.st_mode) &&
                    there.st_uid == ::geteuid() && there.st_size > 0 &&
                    ::flock(file.get(), LOCK_EX | LOCK_NB) == 0;
  return ours ? rename_cut_off(partial, path) : "";
}

}  // namespace framewatch::drivers
