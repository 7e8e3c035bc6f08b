#pragma once

#include <string>

namespace framewatch::drivers {

/// What an output is called that goes to standard output: "-".
inline constexpr const char* kStandardOutput = "-";
/// What standard input is called once keep_standard_input() made a file of it.
inline constexpr const char* kStandardInput = "/dev/stdin";

/// Makes standard input a regular file under the name kStandardInput: what a pipe or a terminal
/// gives is taken to its end into a file without a name, which goes with the process. Every reader
/// then reads it as it reads files, forwards, backwards and more than once. Empty, or why not: also
/// when more comes than unpack_limit() allows of a file of that size.
std::string keep_standard_input();

/// The folder that relative paths in the file `path` start from; empty: the working directory, as
/// of standard input.
std::string folder_of_paths_in(const std::string& path);

}  // namespace framewatch::drivers
