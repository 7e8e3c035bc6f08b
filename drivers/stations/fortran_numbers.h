// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "drivers/files/file_problems.h"
#include "drivers/files/line_reader.h"

namespace framewatch::drivers {

/// Describes numbers in columns of one width, as Fortran writes them without separators.
struct FortranFormat {
  std::size_t per_line = 0;
  std::size_t width = 0;  ///< characters
};

/// Finds the format in a text such as "Format=(8F10.3)". Returns nullopt when there is no format.
std::optional<FortranFormat> find_fortran_format(std::string_view text);

/// Reads `count` numbers from the lines that follow. Returns nullopt with a problem that names
/// `what` when there are fewer, or when one is not a finite number.
std::optional<std::vector<double>> read_fortran_numbers(LineReader& lines,
                                                        const FortranFormat& format,
                                                        std::size_t count, std::string_view what,
                                                        FileProblems& problems);

}  // namespace framewatch::drivers
