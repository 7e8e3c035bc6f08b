// SPDX-License-Identifier: MIT
#include "drivers/records/record_csv_writer.h"

#include <cmath>
#include <iterator>

#include <fmt/format.h>

namespace framewatch::drivers {

bool RecordCsvWriter::open(const std::string& path, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (name.find_first_of(",\"\r\n") == std::string::npos) continue;
    error_ = fmt::format("channel name '{}' must not contain a comma, quote or line end", name);
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
