// SPDX-License-Identifier: MIT
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
  sac,
  csmip,
  esm,
  geonet
};

/// Declares what a record file does not say itself. It is a problem to declare something that the
/// file states, and to leave out something that decides between two readings of the file.
struct RecordOptions {
  RecordFormat format = RecordFormat::detect;
  std::optional<double> unit_mps2;  ///< m/s^2 in one unit of the file
  std::string station_xml;  ///< path of a StationXML file that describes the channels, or empty
  std::optional<double> step_s;       ///< time between samples
  std::string time_column;            ///< title of the time column; empty: found by common titles
  std::optional<double> time_unit_s;  ///< seconds in one unit of that column
  std::optional<int> zone_min;        ///< minutes ahead of UTC of time stamps without a zone
  std::optional<char> decimal;        ///< '.' or ','
  std::vector<std::string> columns;   ///< titles of the columns to read; empty: all but the time
  std::vector<std::string>
      names;  ///< new channel names in the file's order; empty: the file's names
};

/// Returns the format of a name in record_format_names(), "two-columns" or "detect". Returns
/// nullopt for any other name.
std::optional<RecordFormat> record_format(std::string_view name);
/// Returns the names of all formats for a message: "csv, at2, ... or geonet".
std::string record_format_names();

}  // namespace framewatch::drivers
