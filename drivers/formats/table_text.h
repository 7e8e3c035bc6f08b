#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/files/file_problems.h"

namespace framewatch::drivers {

/// What stands between the columns of a line: the first of ';', tab and ',' that is in it outside
/// of quotes, else ' ' for any number of blanks.
char delimiter_of(std::string_view line);

/// Cells of a line as spreadsheets write them: trimmed, without the quotes around them, "" within
/// them a quote. Empty when a quote is not closed.
std::optional<std::vector<std::string>> split_cells(std::string_view line, char delimiter);

/// Blank, or begins with '#', '%' or "//".
bool is_comment(std::string_view line);

/// What parse_sample() takes, with the file's decimal sign, and "NA", "N/A", "#N/A" and "null" for
/// a missing value.
std::optional<double> parse_cell(std::string_view text, char decimal);

/// Whether `text` begins a row of numbers or of time stamps.
bool begins_data(std::string_view text);

/// Finds out by all cells of a file whether its numbers have decimal points or commas.
class DecimalScan {
 public:
  void add(std::int64_t line, std::string_view cell);
  /// Empty, with a problem, when the file contradicts itself, or when all its commas can separate
  /// thousands: that is to be declared.
  std::optional<char> decimal(FileProblems& problems) const;

 private:
  struct Seen {
    std::int64_t line = 0;  ///< 0: not yet
    std::string text;
  };
  Seen point_, comma_, thousands_;  ///< commas that can only be decimal, or could be something else
};

}  // namespace framewatch::drivers
