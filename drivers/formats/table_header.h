#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/files/file_problems.h"

namespace framewatch::drivers {

struct RecordOptions;

/// "floor1 [g]", "floor1 (m/s^2)": a column's name and the unit behind it.
struct ColumnTitle {
  std::string name;
  std::optional<std::string> unit;  ///< as it is written; empty: it says none
};

/// A pair of brackets at the end is a unit when they are [] or when it is one of acceleration,
/// force or time; otherwise it belongs to the name. "time_ms" is "time" in ms.
ColumnTitle column_title(const std::string& text);

/// Whether people call the column of times so: Time, t, timestamp, seconds, ...
bool is_time_title(const std::string& text);

/// How the columns of a table are to be read.
struct TableColumns {
  std::size_t count = 0;            ///< cells in a row
  std::optional<std::size_t> time;  ///< none: the step was declared
  double time_unit_s = 1;
  bool time_unit_said = false;
  struct Channel {
    std::size_t column;
    std::string name;
    double unit_mps2;  ///< or N of one of a force's
    bool is_force = false;
  };
  std::vector<Channel> channels;
  std::vector<std::string> notes;
};

/// The columns of a table by its titles, the units of a line of their own (or none), and what was
/// declared. Empty, with every problem, when something can be read in two ways: then the option
/// that decides is named.
std::optional<TableColumns> table_columns(const std::vector<std::string>& titles,
                                          const std::vector<std::string>& units,
                                          const RecordOptions& options, std::int64_t line,
                                          FileProblems& problems);

}  // namespace framewatch::drivers
