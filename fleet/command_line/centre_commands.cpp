#include <CLI/CLI.hpp>

#include "daemon/command_line/command_list.h"
#include "fleet/command_line/fleet_commands.h"
#include "fleet/worker/worker_command.h"

namespace framewatch::fleet {

void add_worker(daemon::CommandList& commands) {
  WorkerArguments& arguments = commands.arguments<WorkerArguments>();
  CLI::App* command =
      commands.add("worker", "at the hub: what buildings say, into PostgreSQL; any number of them");
  command->footer(
      "Makes the tables, and waits for hub and database as long as they are away: what is not\n"
      "stored is not acknowledged. DIR has worker.pem, worker.key and ca.pem (fleet authority).\n"
      "Exit status: 0 stopped, 2 bad usage or certificates.\n"
      "Example: framewatch fleet worker --hub tls://hub1.example.org:4222 --database "
      "postgresql://fleet@db/fleet");
  command->add_option("--hub", arguments.hubs, "server, tls://HOST:PORT; once for each")
      ->required();
  command->add_option("--dir", arguments.directory, "folder of the certificates")
      ->type_name("DIR")
      ->capture_default_str();
  command
      ->add_option("--database", arguments.database,
                   "of PostgreSQL: a connection string or URI; the environment (PGHOST, ...) says\n"
                   "the rest")
      ->required();
  command->add_flag("--quiet", arguments.quiet, "only what goes wrong");
  commands.set_action(command, [&arguments] { return worker_command(arguments); });
}

}  // namespace framewatch::fleet
