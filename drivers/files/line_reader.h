#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "drivers/files/file_problems.h"
#include "drivers/files/gzip_input.h"

namespace framewatch::drivers {

/// Reads a text file, plain or gzip, line by line in bounded memory. A byte-order mark and carriage
/// returns at line ends are taken off.
class LineReader {
 public:
  static constexpr std::size_t kMaxLineBytes = 1 << 20;

  explicit LineReader(FileProblems& problems);
  LineReader(const LineReader&) = delete;
  LineReader& operator=(const LineReader&) = delete;

  /// False at the end, and when the file cannot be read further, is not text or unpacks to more
  /// than unpack_limit(): that is a problem. The line is valid until the next call.
  [[nodiscard]] bool next(std::string_view& line);
  /// Of the line last read, from 1.
  std::int64_t number() const { return number_; }
  /// The line last read has its line end: nothing of it was cut off.
  bool line_ended() const { return line_ended_; }

 private:
  bool fill();
  bool fail(const std::string& message);

  FileProblems& problems_;
  GzipInput file_;
  std::string buffer_;
  std::size_t begin_ = 0;
  std::int64_t number_ = 0;
  bool ended_ = false;
  bool line_ended_ = true;
};

}  // namespace framewatch::drivers
