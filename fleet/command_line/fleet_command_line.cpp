#include "fleet/command_line/fleet_command_line.h"

#include "daemon/command_line/command_line.h"
#include "daemon/command_line/command_list.h"
#include "fleet/command_line/fleet_commands.h"

namespace framewatch::fleet {

int run_fleet_command_line(int argc, const char* const* argv) {
  const daemon::Program program{"framewatch fleet",
                                "framewatch fleet: many buildings, each with its own framewatch.",
                                "`framewatch uplink` is `framewatch fleet uplink`.",
                                {add_manifest, add_task, add_uplink, add_setup, add_authority,
                                 add_request, add_enroll, add_revoke, add_worker, add_fleet_serve,
                                 add_person, add_describe, add_export, daemon::add_help},
                                {"uplink", "worker", "serve"}};
  return daemon::run_program(program, argc, argv);
}

}  // namespace framewatch::fleet
