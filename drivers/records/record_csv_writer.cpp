// SPDX-License-Identifier: MIT
#include "drivers/records/record_csv_writer.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "drivers/files/file_problems.h"

namespace framewatch::drivers {

bool RecordCsvWriter::open(const std::string& path, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const bool bad = std::any_of(name.begin(), name.end(), [](unsigned char c) {
      return c == ',' || c == '"' || c < 0x20 || c == 0x7f;
    });
    if (!bad) continue;
    error_ = fmt::format("channel name {} must not contain commas, quotes or control characters",
                         show_text(name));
    return false;
  }
  line_ = "time_s";
  for (const std::string& name : names) line_ += "," + name;
  return file_.open(path) && file_.write(line_ + "\n");
}

bool RecordCsvWriter::write(double time_s, const std::vector<double>& accel_mps2) {
  line_.clear();
  fmt::format_to(std::back_inserter(line_), "{}", time_s);
  for (const double value : accel_mps2) {
    line_ += ',';
    if (!std::isnan(value)) fmt::format_to(std::back_inserter(line_), "{}", value);
  }
  line_ += '\n';
  return file_.write(line_);
}

}  // namespace framewatch::drivers
