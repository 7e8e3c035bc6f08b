// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

namespace framewatch::daemon {

/// Returns the first line of a file with a secret, without surrounding blanks. Returns nullopt and
/// sets `trouble`, which names the file, if it cannot be read or the line is empty.
std::optional<std::string> read_secret(const std::string& path, std::string& trouble);

}  // namespace framewatch::daemon
