// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string_view>

#include "drivers/files/file_problems.h"
#include "drivers/records/record.h"
#include "drivers/records/record_options.h"

// Readers of tables for read_record (drivers/stations has the others). Each reads the file
// problems.path() and returns nullopt with its problems when the file breaks a rule of its format.
namespace framewatch::drivers {

/// Returns true if a line is the header of a table: one of its cells is the title of a time column.
bool is_table_header(std::string_view line, const RecordOptions& options);
/// Reads columns with a header, as spreadsheets and loggers write them.
std::optional<Record> read_csv(const RecordOptions& options, FileProblems& problems);
/// Reads PEER AT2.
std::optional<Record> read_at2(FileProblems& problems);
/// Reads the CSV files of Xsens DOT sensors.
std::optional<Record> read_xsens(FileProblems& problems);
/// Reads lines with a time in s and the same number of accelerations, in units of `unit_mps2`.
std::optional<Record> read_columns(double unit_mps2, FileProblems& problems);
/// Reads MATLAB files of level 5 or 7.3. Vectors, columns of matrices and fields of structs become
/// the columns of a table.
std::optional<Record> read_mat(const RecordOptions& options, FileProblems& problems);
/// Reads the accelerations of one channel, `step_s` seconds apart, in units of `unit_mps2`. Every
/// line but the last has the same number of them.
std::optional<Record> read_rows(double unit_mps2, double step_s, FileProblems& problems);

}  // namespace framewatch::drivers
