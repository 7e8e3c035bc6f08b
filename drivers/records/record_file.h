#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/base/problem.h"
#include "drivers/records/accel_unit.h"
#include "drivers/records/record.h"

namespace framewatch::drivers {

enum class RecordFormat { detect, csv, at2, two_columns, rows, xsens };

struct RecordOptions {
  RecordFormat format = RecordFormat::detect;
  std::optional<AccelUnit> unit;  ///< for formats that do not state their unit, and only for them
  std::optional<double> step_s;   ///< time between samples, for formats that do not state it
};

/// "csv", "at2", "two-columns", "rows", "xsens", and "detect".
std::optional<RecordFormat> record_format(std::string_view name);

/// Reads a record file, plain or gzip. The format is found from the content unless it is given.
/// Time is the file's own: the device clock for Xsens, from 0 where the file has none. Lost samples
/// are filled with NaN and noted when the time they leave out is a whole number of steps. A column
/// without a name is named as the file. Empty, with every problem at file:line (at most 20), when
/// the file breaks a rule of its format.
std::optional<Record> read_record(const std::string& path, const RecordOptions& options,
                                  std::vector<Problem>& problems);

}  // namespace framewatch::drivers
