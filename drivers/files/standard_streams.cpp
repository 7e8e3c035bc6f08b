// SPDX-License-Identifier: MIT
#include "drivers/files/standard_streams.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <vector>

#include "drivers/files/descriptor.h"
#include "drivers/files/input_file.h"

namespace framewatch::drivers {
namespace {

constexpr std::size_t kReadAtOnce = 1 << 16;
constexpr std::int64_t kAnySize = std::int64_t{1} << 40;  ///< a pipe has no size: allow the most

/// Returns true if standard input is a file at its start. Another process may have read its
/// beginning.
bool is_whole_file() {
  struct stat status {};
  return ::fstat(STDIN_FILENO, &status) == 0 && S_ISREG(status.st_mode) &&
         ::lseek(STDIN_FILENO, 0, SEEK_CUR) == 0;
}

std::string take_everything(int to) {
  std::vector<char> bytes(kReadAtOnce);
  std::int64_t sum = 0;
  for (;;) {
    const ssize_t got = ::read(STDIN_FILENO, bytes.data(), bytes.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return std::strerror(errno);
    if (got == 0) return {};
    sum += got;
    if (sum > unpack_limit(kAnySize))
      return "is longer than " + size_text(unpack_limit(kAnySize)) + "; --max-size allows more";
    if (!write_fully(to, bytes.data(), static_cast<std::size_t>(got)))
      return std::string("cannot be kept in a temporary file: ") + std::strerror(errno);
  }
}

}  // namespace

std::string keep_standard_input() {
  if (is_whole_file()) return {};
  std::FILE* const kept = std::tmpfile();
  if (kept == nullptr)
    return std::string("cannot be kept in a temporary file: ") + std::strerror(errno);
  std::string why = take_everything(::fileno(kept));
  if (why.empty() && ::dup2(::fileno(kept), STDIN_FILENO) < 0) why = std::strerror(errno);
  (void)std::fclose(kept);
  return why;
}

std::string folder_of_paths_in(const std::string& path) {
  return path == kStandardInput ? std::string()
                                : std::filesystem::path(path).parent_path().string();
}

}  // namespace framewatch::drivers
