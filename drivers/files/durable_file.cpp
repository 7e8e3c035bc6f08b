// SPDX-License-Identifier: MIT
#include "drivers/files/durable_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <future>
#include <utility>

#include "drivers/files/caught.h"
#include "drivers/files/descriptor.h"
#include "drivers/files/partial_file.h"

namespace framewatch::drivers {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kWrite{250}, kSync{1000};
constexpr std::size_t kWriteAtOnce = std::size_t{1}
                                     << 20;  // more is written without waiting for kWrite

/// Returns true if a path names an open file.
bool names(const std::string& path, int file) {
  struct stat named {
  }, open{};
  return ::stat(path.c_str(), &named) == 0 && ::fstat(file, &open) == 0 &&
         named.st_ino == open.st_ino && named.st_dev == open.st_dev;
}

/// Forces a file onto the disk, and the name `fresh` unless it is empty. Returns what went wrong.
std::string force(int file, const std::string& fresh) {
  const std::string why = ::fsync(file) == 0 ? "" : std::strerror(errno);
  if (!fresh.empty()) sync_folder_of(fresh);
  return why;
}

}  // namespace

DurableFile::~DurableFile() {
  finish(std::chrono::milliseconds(0));
  if (file_ >= 0) ::close(file_);
}

bool DurableFile::make(std::string& error) {
  file_ = ::open((path_ + ".partial").c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC,
                 0644);
  if (file_ < 0) {
    error = path_ + ".partial: " + std::strerror(errno);
    return false;
  }
  ::flock(file_, LOCK_EX | LOCK_NB);
  return true;
}

bool DurableFile::open(const std::string& path, std::string& error) {
  path_ = path;
  if (!make(error)) return false;
  start();
  return true;
}

void DurableFile::open_when_needed(std::function<std::string()> path) {
  path_when_needed_ = std::move(path);
  start();
}

void DurableFile::start() {
  closing_ = false;
  wanted_ = true;
  begin_thread();
}

/// append() calls this again while the system has no thread to give.
void DurableFile::begin_thread() {
  if (thread_.joinable()) return;
  const std::string thrown = caught([this] { thread_ = std::thread([this] { work(); }); });
  if (thrown.empty()) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  trouble_ = "cannot start a thread to write it: " + thrown;
}

bool DurableFile::in_use(const std::string& path) {
  const Descriptor file(open_own_file(path + ".partial", O_RDONLY));
  return file.get() >= 0 && ::flock(file.get(), LOCK_EX | LOCK_NB) != 0;
}

bool DurableFile::append(std::string_view bytes) {
  if (wanted_) begin_thread();
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::size_t queued = filling_.size() + waiting_ + bytes.size();
  if (queued > queue_bytes_ || closing_) {
    ++counters_.dropped;
    return false;
  }
  filling_ += bytes;
  ++counters_.appended;
  counters_.queue_high_water = std::max(counters_.queue_high_water, queued);
  if (filling_.size() >= kWriteAtOnce) wake_.notify_one();
  return true;
}

DurableFile::Counters DurableFile::counters() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  Counters counters = counters_;
  counters.queued = filling_.size() + waiting_;
  return counters;
}

std::string DurableFile::trouble() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return trouble_;
}

bool DurableFile::is_lost() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return lost_;
}

bool DurableFile::write_some() {
  if (file_ < 0 && !writing_.empty()) {
    std::string why;
    path_ = path_when_needed_();
    if (!make(why)) {
      const std::lock_guard<std::mutex> lock(mutex_);
      trouble_ = std::move(why);
      return false;
    }
  }
  while (written_ < writing_.size()) {
    const ssize_t n = ::write(file_, writing_.data() + written_, writing_.size() - written_);
    if (n < 0 && errno == EINTR) continue;
    const std::string why = n > 0 ? "" : std::strerror(errno);
    const std::lock_guard<std::mutex> lock(mutex_);
    trouble_ = why;
    if (n <= 0) return false;
    // A partial write continues where it stopped, so that no event is torn.
    written_ += static_cast<std::size_t>(n);
    waiting_ = writing_.size() - written_;
    counters_.bytes += n;
  }
  return true;
}

void DurableFile::work() {
  Clock::time_point next_sync = Clock::now() + kSync;
  bool dirty = false, fresh = true;
  std::future<std::string> forcing;  // runs in another thread, so that writing goes on
  const auto forced = [&] {
    const std::string why = forcing.get();
    if (why.empty()) return;
    dirty = true;
    const std::lock_guard<std::mutex> lock(mutex_);
    trouble_ = why;
  };
  for (bool last = false; !last;) {
    const bool done = write_some();
    {
      std::unique_lock<std::mutex> lock(mutex_);
      if (done) {
        writing_.clear();
        written_ = waiting_ = 0;
      }
      if (!closing_ && !(done && filling_.size() >= kWriteAtOnce)) wake_.wait_for(lock, kWrite);
      if (done) {
        std::swap(writing_, filling_);
        waiting_ = writing_.size();
        dirty = dirty || waiting_ > 0;
      }
      last = closing_ && ((done && waiting_ == 0) || (!done && Clock::now() >= give_up_));
    }
    if (!done && !last) std::this_thread::sleep_for(kWrite / 5);
    if (forcing.valid() &&
        (last || forcing.wait_for(std::chrono::seconds(0)) != std::future_status::timeout))
      forced();
    if (!last && (forcing.valid() || Clock::now() < next_sync)) continue;
    next_sync = Clock::now() + kSync;
    if (file_ >= 0 && !names(path_ + ".partial", file_)) {
      const std::lock_guard<std::mutex> lock(mutex_);
      lost_ = true;
    }
    if (!dirty || file_ < 0) continue;
    dirty = false;
    // Deferred, so run in this thread, when the system has no thread to give.
    forcing = std::async(std::launch::async | std::launch::deferred, &force, file_,
                         std::exchange(fresh, false) ? path_ : std::string());
    if (last) forced();
  }
}

void DurableFile::finish(std::chrono::milliseconds patience) {
  if (!std::exchange(wanted_, false)) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    closing_ = true;
    give_up_ = Clock::now() + patience;
  }
  wake_.notify_one();
  if (thread_.joinable())
    thread_.join();
  else
    work();  // no thread could be started: write here
}

bool DurableFile::close(std::string& error, std::chrono::milliseconds patience) {
  if (!is_open()) return false;
  finish(patience);
  error = trouble_;
  if (error.empty() && waiting_ > 0) error = "not all bytes were written";
  if (file_ < 0) return error.empty();
  if (error.empty() && std::rename((path_ + ".partial").c_str(), path_.c_str()) != 0)
    error = std::strerror(errno);
  ::close(file_);
  file_ = -1;
  sync_folder_of(path_);
  if (!error.empty()) error = path_ + ".partial: " + error;
  return error.empty();
}

}  // namespace framewatch::drivers
