#include "drivers/files/gzip_input.h"

#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fmt/core.h>

#include "drivers/files/bytes_read.h"
#include "drivers/files/input_file.h"
#include "drivers/files/unpack_limit.h"

namespace framewatch::drivers {
namespace {

constexpr std::int64_t kMaxOfGzread = std::int64_t{1} << 20;

}  // namespace

GzipInput::~GzipInput() {
  if (file_ != nullptr) gzclose(file_);
}

bool GzipInput::open(const std::string& path) {
  InputFile input;
  if (!input.open(path)) {
    error_ = "cannot be opened: " + input.error();
    return false;
  }
  packed_bytes_ = input.size();
  file_ = gzdopen(input.release(), "rb");
  if (file_ == nullptr) error_ = "cannot be opened: no memory is left";
  return file_ != nullptr;
}

std::int64_t GzipInput::read(void* to, std::int64_t bytes) {
  std::int64_t done = 0;
  while (file_ != nullptr && error_.empty() && done < bytes) {
    errno = 0;
    const std::int64_t wanted = std::min(bytes - done, kMaxOfGzread);
    const z_off_t before = gzoffset(file_);
    const int got = gzread(file_, static_cast<char*>(to) + done, static_cast<unsigned int>(wanted));
    count_bytes_read(gzoffset(file_) - before);
    done += std::max(got, 0);
    unpacked_bytes_ += std::max(got, 0);
    if (gzdirect(file_) == 0 && unpacked_bytes_ > unpack_limit(packed_bytes_)) {
      error_ = over_unpack_limit(packed_bytes_);
    } else if (got < wanted) {
      int code = Z_OK;
      const char* text = gzerror(file_, &code);
      if (code == Z_BUF_ERROR)
        error_ = "the gzip stream is cut off";
      else if (code == Z_ERRNO)
        error_ = fmt::format("cannot be read: {}", std::strerror(errno));
      else if (code != Z_OK && code != Z_STREAM_END)
        error_ = fmt::format("the gzip stream is damaged: {}", text);
      break;
    }
  }
  return error_.empty() ? done : -1;
}

}  // namespace framewatch::drivers
