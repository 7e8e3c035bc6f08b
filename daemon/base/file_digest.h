#pragma once

#include <optional>
#include <string>

namespace framewatch::daemon {

/// A text file of at most 16 MiB; empty with the reason when it cannot be read.
std::optional<std::string> read_text_file(const std::string& path, std::string& error);

/// SHA-256, 64 lower-case hexadecimal digits.
std::string sha256(const std::string& bytes);
/// SHA-256 of a file of any size; empty when it cannot be read.
std::string sha256_of_file(const std::string& path);

}  // namespace framewatch::daemon
