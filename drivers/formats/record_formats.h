#pragma once

#include <optional>
#include <string_view>

#include "drivers/files/file_problems.h"
#include "drivers/records/record.h"
#include "drivers/records/record_options.h"

// The readers of tables behind read_record, one file each (the others: drivers/stations). All of
// them report to `problems` and return nothing when there is a problem.
namespace framewatch::drivers {

/// Whether a line is the header of a table: one of its cells is what a column of times is called.
bool is_table_header(std::string_view line, const RecordOptions& options);
/// Columns with a header, as spreadsheets and loggers write them.
std::optional<Record> read_csv(const RecordOptions& options, FileProblems& problems);
std::optional<Record> read_at2(FileProblems& problems);
std::optional<Record> read_xsens(FileProblems& problems);
/// On every line the time in s, then the same number of accelerations.
std::optional<Record> read_columns(double unit_mps2, FileProblems& problems);
/// MATLAB, level 5 or 7.3: vectors, columns of matrices, and fields of structs, as if they were
/// columns of a table.
std::optional<Record> read_mat(const RecordOptions& options, FileProblems& problems);
/// Accelerations of one channel, the same number on every line but the last, `step_s` apart.
std::optional<Record> read_rows(double unit_mps2, double step_s, FileProblems& problems);

}  // namespace framewatch::drivers
