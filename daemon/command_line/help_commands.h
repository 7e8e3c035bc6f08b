// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/command_line/command_list.h"
#include "daemon/command_line/option_entries.h"

namespace framewatch::daemon {

/// Returns the manual page framewatch(1), in the language of man(7).
std::string program_man_page(const std::vector<CommandEntry>& commands);
/// Returns the manual page framewatch-<command>(1) of one command. `program`: its name in the page.
std::string command_man_page(const std::string& program, const CommandEntry& command);

/// Adds the commands that every program has: `help` and `completion`.
void add_help(CommandList& commands);
void add_completion(CommandList& commands);

}  // namespace framewatch::daemon
