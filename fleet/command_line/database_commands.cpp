// SPDX-License-Identifier: MIT
#include <CLI/CLI.hpp>

#include "daemon/command_line/command_list.h"
#include "fleet/command_line/fleet_commands.h"
#include "fleet/sds/export_command.h"
#include "fleet/serve/person_command.h"
#include "fleet/serve/serve_command.h"
#include "fleet/worker/worker_command.h"

namespace framewatch::fleet {
namespace {

constexpr int kHighestPort = 65535;

void add_database(CLI::App* command, std::string& database) {
  command
      ->add_option("--database", database,
                   "PostgreSQL connection string or URI; missing parts come from the environment\n"
                   "(PGHOST, ...)")
      ->required();
}

void add_certificates(CLI::App* command, std::string& directory) {
  command->add_option("--dir", directory, "folder of the certificates")
      ->type_name("DIR")
      ->capture_default_str();
}

}  // namespace

void add_worker(daemon::CommandList& commands) {
  WorkerArguments& arguments = commands.arguments<WorkerArguments>();
  CLI::App* command = commands.add(
      "worker", "at the hub: store messages of buildings in PostgreSQL; run any number of workers");
  command->footer(
      "Creates the tables. Waits while the hub or the database is away; acknowledges only what is\n"
      "stored. DIR has worker.pem, worker.key and ca.pem (fleet authority).\n"
      "Exit status: 0 stopped, 2 bad usage or certificates.\n"
      "Example: framewatch fleet worker --hub tls://hub1.example.org:4222 --database "
      "postgresql://fleet@db/fleet");
  add_hubs(command, arguments.hubs)->required();
  add_certificates(command, arguments.directory);
  add_database(command, arguments.database);
  command->add_flag("--quiet", arguments.quiet, "log only problems");
  commands.set_action(command, [&arguments] { return worker_command(arguments); });
}

void add_fleet_serve(daemon::CommandList& commands) {
  FleetServeArguments& arguments = commands.arguments<FleetServeArguments>();
  CLI::App* command = commands.add(
      "serve", "at the hub: show all buildings, earthquakes and commands in the browser");
  command->footer(
      "Reads the database of the workers. With --hub, operators can give commands to buildings; "
      "DIR\n"
      "has page.pem, page.key and ca.pem (fleet authority). Without --people, anyone on this "
      "machine\n"
      "may view and no one may give commands. Other machines need a proxy with TLS, or\n"
      "ssh -L 8090:localhost:8090. Exit status: 0 stopped, 2 bad usage, people or certificates.\n"
      "Example: framewatch fleet serve --database postgresql:///fleet --people people \\\n"
      "  --hub tls://hub1.example.org:4222 --dir hub");
  add_database(command, arguments.database);
  add_hubs(command, arguments.hubs);
  add_certificates(command, arguments.directory);
  command
      ->add_option("--people", arguments.people,
                   "file of people who may view and give commands (fleet person)")
      ->type_name("FILE");
  command
      ->add_option("--address", arguments.address,
                   "address to listen on; other than 127.0.0.1 needs --people")
      ->capture_default_str();
  command->add_option("--port", arguments.port, "port; 0: any free port")
      ->check(CLI::Range(0, kHighestPort))
      ->capture_default_str();
  command->add_option("--host", arguments.hosts,
                      "further host name that requests may use, behind a proxy");
  command
      ->add_option("--files", arguments.files,
                   "folder of page files that replace the built-in ones")
      ->type_name("DIR");
  command->add_flag("--quiet", arguments.quiet, "log only problems");
  commands.set_action(command, [&arguments] { return fleet_serve_command(arguments); });
}

void add_person(daemon::CommandList& commands) {
  PersonArguments& arguments = commands.arguments<PersonArguments>();
  CLI::App* command = commands.add(
      "person", "create a token for the page of `fleet serve`: printed once, stored as SHA-256");
  command->footer(
      "Run it again to replace a lost token. `fleet serve` reads the file when it starts.\n"
      "Example: framewatch fleet person alice --role operator --people people");
  command->add_option("NAME", arguments.name, "name of the person in the journal")->required();
  command->add_option("--role", arguments.role, "viewer, or operator, who may also give commands")
      ->check(CLI::IsMember({"viewer", "operator"}))
      ->capture_default_str();
  command->add_option("--people", arguments.people, "file; created if missing")
      ->type_name("FILE")
      ->capture_default_str();
  command->add_flag("--remove", arguments.remove, "remove the person");
  commands.set_action(command, [&arguments] { return person_command(arguments); });
}

void add_describe(daemon::CommandList& commands) {
  DescribeArguments& arguments = commands.arguments<DescribeArguments>();
  CLI::App* command =
      commands.add("describe", "at the hub: set the title, place and map position of a building");
  command->footer(
      "Keeps values that are not given. A retired building leaves the overview and gets no "
      "commands.\n"
      "Example: framewatch fleet describe kobe-03 --database postgresql:///fleet \\\n"
      "  --title \"Harbor tower\" --place Kobe --latitude 34.69 --longitude 135.19");
  add_building(command, arguments.building);
  add_database(command, arguments.database);
  command->add_option("--title", arguments.title, "title of the building");
  command->add_option("--place", arguments.place, "town, street");
  command->add_option("--latitude", arguments.latitude, "degrees north")
      ->check(CLI::Range(-90.0, 90.0));
  command->add_option("--longitude", arguments.longitude, "degrees east")
      ->check(CLI::Range(-180.0, 180.0));
  command->add_option("--network", arguments.network, "SEED network code, for fleet export (XX)");
  command->add_option("--station", arguments.station, "SEED station code (B and a number)");
  CLI::Option* retired = command->add_flag("--retired", arguments.retired, "retire the building");
  command->add_flag("--not-retired", arguments.not_retired, "restore a retired building")
      ->excludes(retired);
  commands.set_action(command, [&arguments] { return describe_command(arguments); });
}

void add_export(daemon::CommandList& commands) {
  ExportArguments& arguments = commands.arguments<ExportArguments>();
  CLI::App* command =
      commands.add("export", "write raw samples fetched from buildings as miniSEED in SDS folders");
  command->footer(
      "DIR/YEAR/NET/STA/CHAN.D/NET.STA.LOC.CHAN.D.YEAR.DAY, which SeisComP, slarchive, ringserver\n"
      "and ObsPy read. Existing samples stay; exporting them again changes nothing. Exit status: "
      "0\n"
      "done, 1 samples are incomplete or unreadable, 2 bad usage or no database.\n"
      "Example: framewatch fleet export --sds archive --database postgresql:///fleet");
  command->add_option("--sds", arguments.root, "folder of the archive; created if missing")
      ->type_name("DIR")
      ->required();
  add_database(command, arguments.database);
  command->add_option("--building", arguments.building, "export only this building");
  command->add_option("--request", arguments.request,
                      "export only this request, as named on the page");
  commands.set_action(command, [&arguments] { return export_command(arguments); });
}

}  // namespace framewatch::fleet
