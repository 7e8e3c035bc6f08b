#pragma once

#include <string>
#include <vector>

#include "drivers/files/text_output.h"

namespace framewatch::drivers {

/// Writes a record CSV: `time_s,<channel names>`, then m/s^2, an empty cell where a value is
/// missing. Numbers are the shortest that read back the same. The file is a TextOutput.
class RecordCsvWriter {
 public:
  /// False when the file cannot be made or a name cannot stand in a CSV; error() says why, here and
  /// below.
  [[nodiscard]] bool open(const std::string& path, const std::vector<std::string>& names);
  [[nodiscard]] bool write(double time_s, const std::vector<double>& accel_mps2);
  [[nodiscard]] bool close() { return file_.close(); }
  const std::string& error() const { return error_.empty() ? file_.error() : error_; }

 private:
  TextOutput file_;
  std::string line_;
  std::string error_;  ///< of a name
};

}  // namespace framewatch::drivers
