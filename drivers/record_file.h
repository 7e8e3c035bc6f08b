#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/record.h"

namespace framewatch::drivers {

enum class RecordFormat { detect, csv, at2, two_columns, rows, xsens };
enum class AccelUnit { g, gal, mps2 };

struct RecordOptions {
  RecordFormat format = RecordFormat::detect;
  std::optional<AccelUnit> unit;  ///< for formats that do not state theirs, and only for them
  std::optional<double> step_s;   ///< likewise: seconds between samples
};

/// "csv", "at2", "two-columns", "rows", "xsens", and "detect".
std::optional<RecordFormat> record_format(std::string_view name);
/// "g" (9.80665 m/s^2), "gal" (0.01 m/s^2), "mps2".
std::optional<AccelUnit> accel_unit(std::string_view name);
double mps2_per(AccelUnit unit);

/// Reads a record file, plain or gzip, whose format is found from its content unless it is given.
/// Time is the file's own: the device clock for Xsens, from 0 where the file has none. A gap of a
/// whole number of steps is filled with NaN and noted. Columns without a name get the file's.
/// Empty, with every problem at file:line (at most 20), when the file breaks a rule of its format.
std::optional<Record> read_record(const std::string& path, const RecordOptions& options,
                                  std::vector<Problem>& problems);

}  // namespace framewatch::drivers
