#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "drivers/files/file_problems.h"
#include "drivers/files/line_reader.h"

namespace framewatch::drivers {

/// Numbers in columns of one width, as Fortran writes them: nothing need stand between two of them.
struct FortranFormat {
  std::size_t per_line = 0;
  std::size_t width = 0;  ///< characters
};

/// The format in a text, "Format=(8F10.3)"; empty when there is none.
std::optional<FortranFormat> find_fortran_format(std::string_view text);

/// Reads so many numbers from the lines that follow. Empty, with a problem that names `what`, when
/// there are fewer or one is none.
std::optional<std::vector<double>> read_fortran_numbers(LineReader& lines,
                                                        const FortranFormat& format,
                                                        std::size_t count, std::string_view what,
                                                        FileProblems& problems);

}  // namespace framewatch::drivers
