// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace framewatch::drivers {

/// The name of an output that goes to standard output.
inline constexpr const char* kStandardOutput = "-";
/// The path of standard input after keep_standard_input().
inline constexpr const char* kStandardInput = "/dev/stdin";

/// Makes standard input a regular file with the path kStandardInput, so that readers can seek in it
/// and read it more than once. Copies a pipe or terminal to its end into a temporary file without a
/// name. Returns an empty string, or what went wrong: also when the input exceeds unpack_limit().
std::string keep_standard_input();

/// Returns the folder that relative paths in the file `path` start from. Returns an empty string
/// for the working directory, which also applies to standard input.
std::string folder_of_paths_in(const std::string& path);

}  // namespace framewatch::drivers
