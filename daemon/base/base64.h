// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace framewatch::daemon {

/// Returns bytes in base64 (RFC 4648), in one line.
std::string base64(std::string_view bytes);

}  // namespace framewatch::daemon
