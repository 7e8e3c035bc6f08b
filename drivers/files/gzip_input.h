#pragma once

#include <cstdint>
#include <string>

struct gzFile_s;

namespace framewatch::drivers {

/// The bytes of a file, plain or gzip, from its beginning on.
class GzipInput {
 public:
  GzipInput() = default;
  explicit GzipInput(const std::string& path) { (void)open(path); }
  ~GzipInput();
  GzipInput(const GzipInput&) = delete;
  GzipInput& operator=(const GzipInput&) = delete;

  /// Once. False, with error(), when it cannot be opened.
  [[nodiscard]] bool open(const std::string& path);
  bool is_open() const { return file_ != nullptr; }
  /// The next `bytes` bytes; fewer only at the end. -1, with error(), when the file cannot be read
  /// further or unpacks to more than unpack_limit().
  [[nodiscard]] std::int64_t read(void* to, std::int64_t bytes);
  const std::string& error() const { return error_; }

 private:
  gzFile_s* file_ = nullptr;
  std::int64_t packed_bytes_ = 0, unpacked_bytes_ = 0;
  std::string error_;
};

}  // namespace framewatch::drivers
