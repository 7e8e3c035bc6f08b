// SPDX-License-Identifier: MIT
#include "drivers/files/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fmt/core.h>

namespace framewatch::drivers {
namespace {

constexpr std::int64_t kMaxAtOnce = std::int64_t{1} << 20;

std::string why_not_regular(mode_t mode) {
  if (S_ISREG(mode)) return {};
  const char* kind = S_ISDIR(mode)                    ? "a directory"
                     : S_ISFIFO(mode)                 ? "a FIFO"
                     : S_ISSOCK(mode)                 ? "a socket"
                     : S_ISCHR(mode) || S_ISBLK(mode) ? "a device"
                                                      : "something else";
  return fmt::format("is {}, not a file", kind);
}
constexpr std::int64_t kBufferBytes = 1 << 20;
std::atomic<std::int64_t> bytes_so_far{0};

// A raw log of `run` has at most 4,000 MB (history.rotate_mb). A log of dead channels packs to
// 1/3,400 of its size (measured), a file built to exhaust memory to 1/32,000.
constexpr std::int64_t kMaxBytes = std::int64_t{4} << 30;
constexpr std::int64_t kMaxTimes = 4000;
constexpr std::int64_t kAlwaysBytes = std::int64_t{64} << 20;

std::atomic<std::int64_t> asked_bytes{0};  // 0: no limit was set

}  // namespace

std::int64_t bytes_read() {
  return bytes_so_far.load(std::memory_order_relaxed);
}

void count_bytes_read(std::int64_t more) {
  bytes_so_far.fetch_add(more, std::memory_order_relaxed);
}

std::string why_no_file(const std::string& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 ? why_not_regular(status.st_mode)
                                            : std::strerror(errno);
}

bool is_absent(const std::string& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) != 0 && (errno == ENOENT || errno == ENOTDIR);
}

bool InputFile::open(const std::string& path) {
  close();
  error_ = why_no_file(path);
  if (!error_.empty()) return false;
  // The name may have changed its meaning since.
  const int file = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  struct stat status {};
  if (file < 0 || ::fstat(file, &status) != 0)
    error_ = std::strerror(errno);
  else
    error_ = why_not_regular(status.st_mode);
  if (file >= 0) adopt(file, status.st_size);
  if (!error_.empty()) close();
  return error_.empty();
}

void InputFile::adopt(int descriptor, std::int64_t size) {
  close();
  descriptor_ = descriptor;
  size_ = size;
}

int InputFile::release() {
  return std::exchange(descriptor_, -1);
}

void InputFile::close() {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
  size_ = 0;
}

std::int64_t InputFile::read(void* to, std::int64_t bytes, std::int64_t offset) {
  std::int64_t done = 0;
  while (done < bytes) {
    const ssize_t got = ::pread(descriptor_, static_cast<char*>(to) + done,
                                static_cast<std::size_t>(bytes - done), offset + done);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) {
      error_ = std::strerror(errno);
      return -1;
    }
    if (got == 0) break;
    done += got;
  }
  count_bytes_read(done);
  return done;
}

std::optional<std::string> read_whole_file(const std::string& path, std::int64_t most_bytes,
                                           std::string& error) {
  InputFile file(path);
  std::string text;
  while (file.error().empty()) {
    const std::int64_t had = std::ssize(text), wanted = std::min(kMaxAtOnce, most_bytes + 1 - had);
    text.resize(static_cast<std::size_t>(had + wanted));
    const std::int64_t got = file.read(text.data() + had, wanted, had);
    text.resize(static_cast<std::size_t>(had + std::max<std::int64_t>(got, 0)));
    if (got >= 0 && got < wanted) return text;
    if (std::ssize(text) <= most_bytes) continue;
    error = "is larger than " + size_text(most_bytes);
    return std::nullopt;
  }
  error = file.error();
  return std::nullopt;
}

std::int64_t unpack_limit(std::int64_t packed_bytes) {
  if (const std::int64_t asked = asked_bytes; asked > 0) return asked;
  return std::min(kMaxBytes, std::max(kAlwaysBytes, kMaxTimes * std::min(packed_bytes, kMaxBytes)));
}

void set_unpack_limit(std::int64_t bytes) {
  asked_bytes = bytes;
}

std::string over_unpack_limit(std::int64_t packed_bytes) {
  return fmt::format("unpacks to more than {}, from {}; --max-size allows more",
                     size_text(unpack_limit(packed_bytes)), size_text(packed_bytes));
}

std::string size_text(std::int64_t bytes) {
  constexpr std::array kUnits{"bytes", "KiB", "MiB", "GiB", "TiB"};
  std::size_t unit = 0;
  auto size = static_cast<double>(bytes);
  for (; size >= 1024 && unit + 1 < kUnits.size(); ++unit) size /= 1024;
  return fmt::format("{:.4g} {}", size, kUnits[unit]);
}

const std::uint8_t* FileWindow::at(std::int64_t offset, std::int64_t bytes, std::string& error) {
  if (holds(offset, bytes)) return buffer_.data() + (offset - begin_);
  const std::int64_t wanted = std::min(std::max(bytes, kBufferBytes), file_.size() - offset);
  if (std::ssize(buffer_) < wanted) buffer_.resize(static_cast<std::size_t>(wanted));
  begin_ = offset;
  held_ = std::max<std::int64_t>(0, file_.read(buffer_.data(), wanted, offset));
  bytes_read_ += held_;
  if (held_ == wanted) return buffer_.data();
  error = file_.error().empty() ? "became shorter while it was read" : file_.error();
  held_ = 0;
  return nullptr;
}

}  // namespace framewatch::drivers
