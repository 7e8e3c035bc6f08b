#include <CLI/CLI.hpp>

#include "daemon/command_line/command_list.h"
#include "fleet/command_line/fleet_commands.h"
#include "fleet/uplink/uplink_command.h"

namespace framewatch::fleet {

void add_uplink(daemon::CommandList& commands) {
  UplinkArguments& arguments = commands.arguments<UplinkArguments>();
  CLI::App* command = commands.add(
      "uplink",
      "beside `framewatch run`: sends what the history holds to the hub of many buildings");
  command->footer(
      "CONFIG has the sections [fleet] and [history]. What the hub has not acknowledged waits in\n"
      "the history, however long there is no hub; `framewatch run` knows nothing of all this.\n"
      "Exit status: 0 stopped, 1 no LCM, 2 bad usage, configuration or certificate.\n"
      "Example: framewatch uplink /etc/framewatch/building.toml");
  daemon::add_config(commands, command, arguments.config);
  daemon::add_url(command, arguments.url);
  command->add_flag("--quiet", arguments.quiet, "only what goes wrong");
  commands.set_action(command, [&arguments] { return uplink_command(arguments); });
}

}  // namespace framewatch::fleet
