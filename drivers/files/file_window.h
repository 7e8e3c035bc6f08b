#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/files/input_file.h"

namespace framewatch::drivers {

/// The part of a file that somebody reads, through a buffer: cheap as long as offsets ascend. Who
/// reads at two places has two windows.
class FileWindow {
 public:
  explicit FileWindow(InputFile& file) : file_(file) {}
  void clear() { begin_ = held_ = bytes_read_ = 0; }
  /// `bytes` bytes at `offset`, valid until the next call; null when the system refuses them or the
  /// file has become shorter, with `error`. Precondition: they lie within the file's size.
  const std::uint8_t* at(std::int64_t offset, std::int64_t bytes, std::string& error);
  bool holds(std::int64_t offset, std::int64_t bytes) const {
    return offset >= begin_ && offset + bytes <= begin_ + held_;
  }
  /// Bytes that were read from the file.
  std::int64_t bytes_read() const { return bytes_read_; }

 private:
  InputFile& file_;
  std::vector<std::uint8_t> buffer_;
  std::int64_t begin_ = 0, held_ = 0, bytes_read_ = 0;
};

}  // namespace framewatch::drivers
