// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "drivers/files/partial_file.h"

struct gzFile_s;

namespace framewatch::drivers {

/// Writes a text file, compressed when its name ends in .gz. The file is a PartialFile until
/// close(), so that its name never shows half-written contents.
class TextOutput {
 public:
  TextOutput() = default;
  /// Removes the partial file when close() was not called.
  ~TextOutput();
  TextOutput(const TextOutput&) = delete;
  TextOutput& operator=(const TextOutput&) = delete;

  /// Creates the partial file. Returns false and sets error() when the system refuses; so do
  /// write() and close().
  [[nodiscard]] bool open(const std::string& path);
  [[nodiscard]] bool write(std::string_view text);
  /// Renames the partial file to its final name.
  [[nodiscard]] bool close();
  const std::string& error() const { return error_; }

 private:
  bool fail();

  PartialFile partial_;
  gzFile_s* file_ = nullptr;
  std::string error_;
};

/// Writes `text` as the file `path`. Returns an empty string, or the path and what went wrong; an
/// older file of that name then stays.
std::string write_text_file(const std::string& path, std::string_view text);

}  // namespace framewatch::drivers
