// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "drivers/files/descriptor.h"

namespace framewatch::daemon {

inline constexpr std::size_t kMaxServedBytes = 16 << 20;

/// Returns the content of folder/names[0]/names[1]/... Returns nullopt unless it is a regular file
/// of at most kMaxServedBytes that is reached without links inside the folder. Never waits for the
/// other end of a pipe or device.
std::optional<std::string> read_served_file(const std::string& folder,
                                            const std::vector<std::string>& names);

/// Opens a file of any size that is reached like that, for reading. Returns a negative descriptor
/// if the path leads to no such file.
drivers::Descriptor open_served_file(const std::string& folder,
                                     const std::vector<std::string>& names);

/// Returns true if read_served_file() would read the file.
bool is_served_file(const std::string& folder, const std::vector<std::string>& names);

}  // namespace framewatch::daemon
