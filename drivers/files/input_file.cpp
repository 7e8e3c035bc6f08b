#include "drivers/files/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fmt/core.h>

#include "drivers/files/bytes_read.h"

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

}  // namespace

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
  // It may be something else by now.
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

std::string size_text(std::int64_t bytes) {
  constexpr std::array kUnits{"bytes", "KiB", "MiB", "GiB", "TiB"};
  std::size_t unit = 0;
  auto size = static_cast<double>(bytes);
  for (; size >= 1024 && unit + 1 < kUnits.size(); ++unit) size /= 1024;
  return fmt::format("{:.4g} {}", size, kUnits[unit]);
}

}  // namespace framewatch::drivers
