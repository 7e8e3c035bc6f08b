#pragma once

namespace framewatch::daemon {
class CommandList;
}

namespace framewatch::fleet {

// Each add_<command> declares a command of framewatch-fleet with its options.

// fleet_command_line.cpp: archives, the uplink of a building, and the worker of a hub.
void add_manifest(daemon::CommandList& commands);
void add_task(daemon::CommandList& commands);
void add_uplink(daemon::CommandList& commands);
void add_worker(daemon::CommandList& commands);

// hub_commands.cpp: certificates and setup of the hub.
void add_request(daemon::CommandList& commands);
void add_setup(daemon::CommandList& commands);
void add_authority(daemon::CommandList& commands);
void add_enroll(daemon::CommandList& commands);
void add_revoke(daemon::CommandList& commands);

// page_commands.cpp: the page of many buildings.
void add_fleet_serve(daemon::CommandList& commands);
void add_person(daemon::CommandList& commands);
void add_describe(daemon::CommandList& commands);
void add_export(daemon::CommandList& commands);

}  // namespace framewatch::fleet
