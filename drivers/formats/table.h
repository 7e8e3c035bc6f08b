// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/files/file_problems.h"

namespace framewatch::drivers {

struct RecordOptions;

/// Returns the delimiter between the columns of a line: the first of ';', tab and ',' that occurs
/// outside quotes, or ' ' for runs of blanks.
char delimiter_of(std::string_view line);

/// Splits a line into cells as spreadsheets write them: trimmed, without the quotes around them,
/// with
/// "" for a quote inside them. Returns nullopt when a quote is not closed.
std::optional<std::vector<std::string>> split_cells(std::string_view line, char delimiter);

/// Returns true if a line is blank or begins with '#', '%' or "//". `delimiter` is the table's;
/// above its header, where it is not yet known, it is '\0'. A line that begins with ';' is a
/// comment when the table has another delimiter; above the header, when it holds commas and no
/// further ';'.
bool is_comment(std::string_view line, char delimiter);

/// Returns true if this first line begins a TOA5 file of a Campbell logger.
bool is_toa5(std::string_view first_line);

/// Returns a line without the mark ";Headers," by which GCDC loggers put the header into a comment.
std::string_view without_header_mark(std::string_view line);

/// Parses what parse_sample() parses, with the decimal sign of the file, and "NA", "N/A", "#N/A"
/// and "null" as missing values (NaN). Returns nullopt for any other text.
std::optional<double> parse_cell(std::string_view text, char decimal);

/// Returns true if `text` begins a row of numbers or time stamps.
bool begins_data(std::string_view text);

/// Finds out from all cells of a file whether its numbers have decimal points or commas. Call add()
/// for every cell, then decimal().
class DecimalScan {
 public:
  void add(std::int64_t line, std::string_view cell);
  /// Returns '.' or ','. Returns nullopt with a problem when the file uses both, or when all its
  /// commas may separate thousands and the user has to declare the sign.
  std::optional<char> decimal(FileProblems& problems) const;

 private:
  struct Seen {
    std::int64_t line = 0;  ///< 0: none seen yet
    std::string text;
  };
  Seen point_;
  Seen comma_;      ///< can only be a decimal comma
  Seen thousands_;  ///< may separate thousands
};

/// A column's name and the unit behind it, from "floor1 [g]" or "floor1 (m/s^2)".
struct ColumnTitle {
  std::string name;
  std::optional<std::string> unit;  ///< as it is written; empty: the title has no unit
};

/// Splits a title into name and unit. Text in [] at the end is a unit; text in () only if it is a
/// unit of acceleration, force or time. "time_ms" is "time" in ms.
ColumnTitle column_title(const std::string& text);

/// Returns true if a title is a usual one for the time column: Time, t, timestamp, seconds, ...
bool is_time_title(const std::string& text);

/// Says how to read the columns of a table.
struct TableColumns {
  std::size_t count = 0;            ///< cells in a row
  std::optional<std::size_t> time;  ///< index of the time column; empty: the step was declared
  double time_unit_s = 1;
  bool time_unit_said = false;
  struct Channel {
    std::size_t column;
    std::string name;
    double unit_mps2;  ///< m/s^2 in one unit of the column; N for a force
    bool is_force = false;
  };
  std::vector<Channel> channels;
  std::vector<std::string> notes;
};

/// Finds the columns of a table from its titles, from a separate line of `units` (may be empty) and
/// from the options. `line` is the line of the header in messages. Returns nullopt with every
/// problem when the table can be read in two ways; the message names the option that decides.
std::optional<TableColumns> table_columns(const std::vector<std::string>& titles,
                                          const std::vector<std::string>& units,
                                          const RecordOptions& options, std::int64_t line,
                                          FileProblems& problems);

}  // namespace framewatch::drivers
