// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "drivers/files/text_output.h"

namespace framewatch::drivers {

/// Writes a record as CSV: the header `time_s,<channel names>`, then rows of m/s^2 with an empty
/// cell for a missing value. Numbers are the shortest that parse back the same. The file is a
/// TextOutput.
class RecordCsvWriter {
 public:
  /// Creates the file and writes its header. Returns false and sets error() when the system refuses
  /// or a name cannot stand in a CSV file.
  [[nodiscard]] bool open(const std::string& path, const std::vector<std::string>& names);
  /// Writes one row, values in the order of the names, NaN for a missing one. Returns false and
  /// sets error() when the system refuses; so does close(), which gives the file its final name.
  [[nodiscard]] bool write(double time_s, const std::vector<double>& accel_mps2);
  [[nodiscard]] bool close() { return file_.close(); }
  const std::string& error() const { return error_.empty() ? file_.error() : error_; }

 private:
  TextOutput file_;
  std::string line_;
  std::string error_;  ///< about a name
};

}  // namespace framewatch::drivers
