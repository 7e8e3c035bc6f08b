#pragma once

#include <cstddef>
#include <optional>

#include "drivers/files/input_file.h"

namespace framewatch::drivers {

/// How many variables a MATLAB file of level 5 has. Empty when it is damaged or cut off: when an
/// element is longer than what it is in, an array has more values than bytes, arrays are in one
/// another deeper than 16, or a compressed one unpacks to more than unpack_limit() or 512 MiB.
/// libmatio takes memory for whatever such a number says, and ends at the first variable that it
/// cannot read, without a word.
std::optional<std::size_t> count_in_level_5(InputFile& input, bool big_endian);

}  // namespace framewatch::drivers
