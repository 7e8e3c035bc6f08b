#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace framewatch::drivers {

enum class RecordFormat {
  detect,
  csv,
  at2,
  columns,
  rows,
  xsens,
  mseed,
  mat,
  cosmos,
  smc,
  knet,
  sac
};

/// What a file does not say itself. Declaring what it says is a problem, and so is leaving out what
/// decides between two readings.
struct RecordOptions {
  RecordFormat format = RecordFormat::detect;
  std::optional<double> unit_mps2;    ///< m/s^2 of one of the file's
  std::string station_xml;            ///< a StationXML file, which says that and more; empty: none
  std::optional<double> step_s;       ///< time between samples
  std::string time_column;            ///< title of the column of times; empty: what it is called
  std::optional<double> time_unit_s;  ///< seconds of one of that column's
  std::optional<int> zone_min;        ///< of time stamps without one, minutes ahead of UTC
  std::optional<char> decimal;        ///< '.' or ','
  std::vector<std::string> columns;   ///< titles of the channels; empty: all but the time
  std::vector<std::string> names;     ///< of the channels, in the file's order; empty: its own
};

/// By its name in record_format_names(), "two-columns" or "detect".
std::optional<RecordFormat> record_format(std::string_view name);
/// "csv, at2, ... or sac"
std::string record_format_names();

}  // namespace framewatch::drivers
