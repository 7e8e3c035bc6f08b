// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

namespace framewatch::daemon {

/// Returns a text file of at most 16 MiB. Returns nullopt and sets `error` if it cannot be read.
std::optional<std::string> read_text_file(const std::string& path, std::string& error);

/// Returns the SHA-256 as 64 lower-case hexadecimal digits.
std::string sha256(const std::string& bytes);
/// Returns the SHA-256 of a file of any size, or an empty text if it cannot be read.
std::string sha256_of_file(const std::string& path);

}  // namespace framewatch::daemon
