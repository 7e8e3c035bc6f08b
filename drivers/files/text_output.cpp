// SPDX-License-Identifier: MIT
#include "drivers/files/text_output.h"

#include <fcntl.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace framewatch::drivers {

TextOutput::~TextOutput() {
  if (file_ != nullptr) gzclose(file_);
}

bool TextOutput::fail() {
  if (error_.empty()) error_ = partial_.error();
  if (error_.empty()) error_ = std::strerror(errno);
  return false;
}

bool TextOutput::open(const std::string& path) {
  if (!partial_.open(path)) return fail();
  const int copy = ::fcntl(partial_.descriptor(), F_DUPFD_CLOEXEC, 0);
  // "T" writes the bytes as they are.
  if (copy >= 0) file_ = gzdopen(copy, path.ends_with(".gz") ? "wb6" : "wbT");
  if (file_ != nullptr) return true;
  fail();
  if (copy >= 0) ::close(copy);
  partial_.discard();
  return false;
}

bool TextOutput::write(std::string_view text) {
  constexpr std::size_t kAtOnce = std::size_t{1} << 30;
  if (file_ == nullptr) return false;
  while (!text.empty()) {
    const auto size = static_cast<unsigned>(std::min(text.size(), kAtOnce));
    if (gzwrite(file_, text.data(), size) != static_cast<int>(size)) return fail();
    text.remove_prefix(size);
  }
  return true;
}

bool TextOutput::close() {
  if (file_ == nullptr) return false;
  if (gzclose(std::exchange(file_, nullptr)) != Z_OK) fail();
  if (error_.empty() && partial_.commit()) return true;
  fail();
  partial_.discard();
  return false;
}

std::string write_text_file(const std::string& path, std::string_view text) {
  TextOutput file;
  if (file.open(path) && file.write(text) && file.close()) return {};
  return path + ": " + file.error();
}

}  // namespace framewatch::drivers
