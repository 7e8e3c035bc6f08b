#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drivers/files/file_problems.h"
#include "drivers/records/record.h"
#include "drivers/records/record_options.h"

namespace framewatch::drivers {

/// Reads a record file, plain or gzip. The format is found from the content unless it is given.
/// Time is the file's own: the device clock for Xsens, from 0 where the file has none. Lost samples
/// are filled with NaN and noted when the time they leave out is a whole number of steps. A column
/// without a name is named as the file. Empty, with every problem at file:line (at most 20), when
/// the file breaks a rule of its format.
std::optional<Record> read_record(const std::string& path, const RecordOptions& options,
                                  std::vector<Problem>& problems);

/// Whether it is what a network of stations publishes (drivers/stations).
bool is_network_file(const std::string& path);

}  // namespace framewatch::drivers
