#pragma once

#include <string>
#include <string_view>

#include "drivers/files/partial_file.h"

struct gzFile_s;

namespace framewatch::drivers {

/// Writes a text file, gzip when its name ends in .gz, as a PartialFile that close() renames:
/// nothing half-written under its name.
class TextOutput {
 public:
  TextOutput() = default;
  /// Removes the partial file when close() was not called.
  ~TextOutput();
  TextOutput(const TextOutput&) = delete;
  TextOutput& operator=(const TextOutput&) = delete;

  [[nodiscard]] bool open(const std::string& path);
  [[nodiscard]] bool write(std::string_view text);
  [[nodiscard]] bool close();
  const std::string& error() const { return error_; }

 private:
  bool fail();

  PartialFile partial_;
  gzFile_s* file_ = nullptr;
  std::string error_;
};

/// A whole text as a file. Empty, or the path and why not; then what was there is still there.
std::string write_text_file(const std::string& path, std::string_view text);

}  // namespace framewatch::drivers
