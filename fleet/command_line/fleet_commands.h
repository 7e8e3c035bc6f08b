#pragma once

namespace framewatch::daemon {
class CommandList;
}

namespace framewatch::fleet {

// Commands of framewatch-fleet: each add_<command> declares one with its options.

// archive_commands.cpp: archives identified anew.
void add_manifest(daemon::CommandList& commands);
void add_task(daemon::CommandList& commands);

// uplink_commands.cpp, hub_commands.cpp: of a building.
void add_uplink(daemon::CommandList& commands);
void add_request(daemon::CommandList& commands);

// hub_commands.cpp: of the hub.
void add_setup(daemon::CommandList& commands);
void add_authority(daemon::CommandList& commands);
void add_enroll(daemon::CommandList& commands);
void add_revoke(daemon::CommandList& commands);

// centre_commands.cpp: what the hub does with what buildings say.
void add_worker(daemon::CommandList& commands);

// page_commands.cpp: what people see of it.
void add_fleet_serve(daemon::CommandList& commands);
void add_person(daemon::CommandList& commands);
void add_describe(daemon::CommandList& commands);
void add_export(daemon::CommandList& commands);

}  // namespace framewatch::fleet
