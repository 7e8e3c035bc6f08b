// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "drivers/files/file_problems.h"
#include "drivers/files/packed_file.h"

namespace framewatch::drivers {

/// Reads a text file, plain or gzip, line by line in bounded memory. Drops a byte-order mark, and
/// carriage returns at line ends.
class LineReader {
 public:
  static constexpr std::size_t kMaxLineBytes = 1 << 20;

  /// Opens problems.path(). A file that cannot be opened becomes a problem. `problems` must outlive
  /// this object.
  explicit LineReader(FileProblems& problems);
  LineReader(const LineReader&) = delete;
  LineReader& operator=(const LineReader&) = delete;

  /// Reads the next line into `line`, valid until the next call. Returns false at the end, and with
  /// a problem when the file cannot be read, is not text, or unpacks to more than unpack_limit().
  [[nodiscard]] bool next(std::string_view& line);
  /// Returns the number of the line last read, counted from 1.
  std::int64_t number() const { return number_; }
  /// Returns true if the line last read has a line end, so that it cannot be cut off.
  bool line_ended() const { return line_ended_; }
  /// Returns the note for a reader that leaves out `what` ("row", "number") at the end of the line
  /// last read, because that line has no line end.
  std::string left_out_note(std::string_view what) const;

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
