#pragma once

namespace framewatch::daemon {
class CommandList;
}

namespace framewatch::fleet {

// archive_commands.cpp: archives identified anew.
void add_manifest(daemon::CommandList& commands);
void add_task(daemon::CommandList& commands);

}  // namespace framewatch::fleet
