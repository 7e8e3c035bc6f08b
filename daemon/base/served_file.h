#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace framewatch::daemon {

inline constexpr std::size_t kMaxServedBytes = 16 << 20;

/// The file folder/names[0]/names[1]/..., if it is a regular one of at most kMaxServedBytes and no
/// link leads to it from the folder on. Never waits for the other end of a pipe or device.
std::optional<std::string> read_served_file(const std::string& folder,
                                            const std::vector<std::string>& names);

/// Whether read_served_file() would read it.
bool is_served_file(const std::string& folder, const std::vector<std::string>& names);

}  // namespace framewatch::daemon
