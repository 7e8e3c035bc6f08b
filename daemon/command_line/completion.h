// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/command_line/option_entries.h"

namespace framewatch::daemon {

/// Returns a completion script for a shell: "bash", "zsh" or "fish".
std::string completion_script(const std::string& shell, const std::vector<CommandEntry>& commands);

}  // namespace framewatch::daemon
