// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace framewatch::daemon {
class CommandList;
}

namespace framewatch::fleet {

// Each add_<command> declares a command of framewatch-fleet with its options.

// fleet_command_line.cpp: archives and the uplink of a building.
void add_manifest(daemon::CommandList& commands);
void add_task(daemon::CommandList& commands);
void add_uplink(daemon::CommandList& commands);

// hub_commands.cpp: certificates and setup of the hub.
void add_request(daemon::CommandList& commands);
void add_setup(daemon::CommandList& commands);
void add_authority(daemon::CommandList& commands);
void add_enroll(daemon::CommandList& commands);
void add_revoke(daemon::CommandList& commands);

// database_commands.cpp: programs that use the database of a hub.
void add_worker(daemon::CommandList& commands);
void add_fleet_serve(daemon::CommandList& commands);
void add_person(daemon::CommandList& commands);
void add_describe(daemon::CommandList& commands);
void add_export(daemon::CommandList& commands);

/// Declares --hub, which may be repeated.
CLI::Option* add_hubs(CLI::App* command, std::vector<std::string>& hubs);
/// Declares the required argument BUILDING.
void add_building(CLI::App* command, std::string& building);

}  // namespace framewatch::fleet
