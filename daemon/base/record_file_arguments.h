// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "drivers/files/file_problems.h"
#include "drivers/formats/record_file.h"

namespace framewatch::daemon {

/// Options of the command line for record files, as text. Empty or 0: not given.
struct RecordFileArguments {
  std::string unit;         ///< g, mg, gal, mps2, or a number: m/s^2 of one
  std::string station_xml;  ///< a file that says what a count is; instead of a unit
  double step_s = 0;
  std::string format = "detect";
  std::string time, time_unit, zone, decimal;
  std::vector<std::string> columns, names;

  bool any() const;
};

/// Returns the options of the readers. Appends a problem for each invalid argument.
drivers::RecordOptions record_options(const RecordFileArguments& arguments,
                                      std::vector<drivers::Problem>& problems);

}  // namespace framewatch::daemon
