#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/base/problem.h"
#include "drivers/records/record.h"

namespace framewatch::drivers {

enum class RecordFormat { detect, csv, at2, columns, rows, xsens };

/// What a file does not say itself. Declaring what it says is a problem, and so is leaving out what
/// decides between two readings.
struct RecordOptions {
  RecordFormat format = RecordFormat::detect;
  std::optional<double> unit_mps2;    ///< m/s^2 of one of the file's
  std::optional<double> step_s;       ///< time between samples
  std::string time_column;            ///< title of the column of times; empty: what it is called
  std::optional<double> time_unit_s;  ///< seconds of one of that column's
  std::optional<int> zone_min;        ///< of time stamps without one, minutes ahead of UTC
  std::optional<char> decimal;        ///< '.' or ','
  std::vector<std::string> columns;   ///< titles of the channels; empty: all but the time
  std::vector<std::string> names;     ///< of the channels, in the file's order; empty: its own
};

/// "csv", "at2", "columns", "two-columns", "rows", "xsens", and "detect".
std::optional<RecordFormat> record_format(std::string_view name);

/// Reads a record file, plain or gzip. The format is found from the content unless it is given.
/// Time is the file's own: the device clock for Xsens, from 0 where the file has none. Lost samples
/// are filled with NaN and noted when the time they leave out is a whole number of steps. A column
/// without a name is named as the file. Empty, with every problem at file:line (at most 20), when
/// the file breaks a rule of its format.
std::optional<Record> read_record(const std::string& path, const RecordOptions& options,
                                  std::vector<Problem>& problems);

}  // namespace framewatch::drivers
