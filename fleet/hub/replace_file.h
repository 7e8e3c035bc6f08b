#pragma once

#include <string>

namespace framewatch::fleet {

/// Replaces a file as a whole. Empty, or "PATH: why not".
std::string replace_file(const std::string& path, const std::string& text);

}  // namespace framewatch::fleet
