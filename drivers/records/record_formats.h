#pragma once

#include <optional>

#include "drivers/base/file_problems.h"
#include "drivers/records/accel_unit.h"
#include "drivers/records/record.h"

// The readers behind read_record, one file each. All of them report to `problems` and return
// nothing when there is a problem.
namespace framewatch::drivers {

std::optional<Record> read_csv(FileProblems& problems);
std::optional<Record> read_at2(FileProblems& problems);
std::optional<Record> read_xsens(FileProblems& problems);
/// Time in s and acceleration in `unit` on every line.
std::optional<Record> read_two_columns(AccelUnit unit, FileProblems& problems);
/// Accelerations in `unit`, the same number on every line but the last, `step_s` apart.
std::optional<Record> read_rows(AccelUnit unit, double step_s, FileProblems& problems);

}  // namespace framewatch::drivers
