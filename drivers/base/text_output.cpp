#include "drivers/base/text_output.h"

#include <zlib.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace framewatch::drivers {

TextOutput::~TextOutput() {
  if (file_ == nullptr) return;
  gzclose(file_);
  std::remove((path_ + ".partial").c_str());
}

bool TextOutput::fail() {
  if (error_.empty()) error_ = std::strerror(errno);
  return false;
}

bool TextOutput::open(const std::string& path) {
  path_ = path;
  errno = 0;
  // "T" writes the bytes as they are.
  file_ = gzopen((path + ".partial").c_str(), path.ends_with(".gz") ? "wbe6" : "wbeT");
  return file_ != nullptr || fail();
}

bool TextOutput::write(std::string_view text) {
  if (text.empty()) return true;
  const auto size = static_cast<unsigned>(text.size());
  return gzwrite(file_, text.data(), size) == static_cast<int>(size) || fail();
}

bool TextOutput::close() {
  const std::string partial = path_ + ".partial";
  const bool flushed = gzclose(file_) == Z_OK;
  file_ = nullptr;
  if (error_.empty() && flushed && std::rename(partial.c_str(), path_.c_str()) == 0) return true;
  fail();
  std::remove(partial.c_str());
  return false;
}

std::string write_text_file(const std::string& path, std::string_view text) {
  TextOutput file;
  if (file.open(path) && file.write(text) && file.close()) return {};
  return path + ": " + file.error();
}

}  // namespace framewatch::drivers
