#include <CLI/CLI.hpp>

#include "daemon/command_line/command_list.h"
#include "fleet/command_line/fleet_commands.h"
#include "fleet/sds/export_command.h"
#include "fleet/serve/person_command.h"
#include "fleet/serve/serve_command.h"

namespace framewatch::fleet {
namespace {

constexpr int kHighestPort = 65535;

void add_database(CLI::App* command, std::string& database) {
  command
      ->add_option("--database", database,
                   "of PostgreSQL: a connection string or URI; the environment (PGHOST, ...) says\n"
                   "the rest")
      ->required();
}

}  // namespace

void add_fleet_serve(daemon::CommandList& commands) {
  FleetServeArguments& arguments = commands.arguments<FleetServeArguments>();
  CLI::App* command = commands.add(
      "serve", "at the hub: every building in the browser, by severity; earthquakes; commands");
  command->footer(
      "Reads the database that workers fill. With --hub operators give commands to buildings: DIR\n"
      "has page.pem, page.key and ca.pem (fleet authority). Without --people who is on this "
      "machine\n"
      "may look, and nobody gives commands. Other machines reach it through a proxy with TLS, or\n"
      "ssh -L 8090:localhost:8090. Exit status: 0 stopped, 2 bad usage, people or certificates.\n"
      "Example: framewatch fleet serve --database postgresql:///fleet --people people \\\n"
      "  --hub tls://hub1.example.org:4222 --dir hub");
  add_database(command, arguments.database);
  command->add_option("--hub", arguments.hubs, "server, tls://HOST:PORT; once for each");
  command->add_option("--dir", arguments.directory, "folder of the certificates")
      ->type_name("DIR")
      ->capture_default_str();
  command->add_option("--people", arguments.people, "who may look, and command (fleet person)")
      ->type_name("FILE");
  command->add_option("--address", arguments.address, "to listen on; another one needs --people")
      ->capture_default_str();
  command->add_option("--port", arguments.port, "0: a free one")
      ->check(CLI::Range(0, kHighestPort))
      ->capture_default_str();
  command->add_option("--host", arguments.hosts,
                      "further name that requests may come under, behind a proxy");
  command->add_option("--files", arguments.files, "folder with the page, for work on it")
      ->type_name("DIR");
  command->add_flag("--quiet", arguments.quiet, "only what goes wrong");
  commands.set_action(command, [&arguments] { return fleet_serve_command(arguments); });
}

void add_person(daemon::CommandList& commands) {
  PersonArguments& arguments = commands.arguments<PersonArguments>();
  CLI::App* command = commands.add(
      "person", "a token for the page of `fleet serve`: printed once, kept as SHA-256");
  command->footer(
      "A token that was lost is replaced by asking again. `fleet serve` reads the file when it "
      "starts.\n"
      "Example: framewatch fleet person alice --role operator --people people");
  command->add_option("NAME", arguments.name, "what the journal calls the person")->required();
  command->add_option("--role", arguments.role, "viewer, or operator, who gives commands too")
      ->check(CLI::IsMember({"viewer", "operator"}))
      ->capture_default_str();
  command->add_option("--people", arguments.people, "file; made if missing")
      ->type_name("FILE")
      ->capture_default_str();
  command->add_flag("--remove", arguments.remove, "takes the token back");
  commands.set_action(command, [&arguments] { return person_command(arguments); });
}

void add_describe(daemon::CommandList& commands) {
  DescribeArguments& arguments = commands.arguments<DescribeArguments>();
  CLI::App* command = commands.add(
      "describe", "at the hub: a building's title, place and position on the map, in the database");
  command->footer(
      "What is not given stays. A retired building is in no overview and gets no command.\n"
      "Example: framewatch fleet describe kobe-03 --database postgresql:///fleet \\\n"
      "  --title \"Harbour tower\" --place Kobe --latitude 34.69 --longitude 135.19");
  command->add_option("BUILDING", arguments.building, "its name at the hub")->required();
  add_database(command, arguments.database);
  command->add_option("--title", arguments.title, "what people call it");
  command->add_option("--place", arguments.place, "town, street");
  command->add_option("--latitude", arguments.latitude, "degrees north")
      ->check(CLI::Range(-90.0, 90.0));
  command->add_option("--longitude", arguments.longitude, "degrees east")
      ->check(CLI::Range(-180.0, 180.0));
  command->add_option("--network", arguments.network, "its network in SEED, for fleet export (XX)");
  command->add_option("--station", arguments.station, "its station in SEED (B and a number)");
  CLI::Option* retired = command->add_flag("--retired", arguments.retired, "it is no more");
  command->add_flag("--not-retired", arguments.not_retired, "it is again")->excludes(retired);
  commands.set_action(command, [&arguments] { return describe_command(arguments); });
}

void add_export(daemon::CommandList& commands) {
  ExportArguments& arguments = commands.arguments<ExportArguments>();
  CLI::App* command = commands.add(
      "export", "raw samples that were fetched from buildings, as miniSEED in the folders of SDS");
  command->footer(
      "DIR/YEAR/NET/STA/CHAN.D/NET.STA.LOC.CHAN.D.YEAR.DAY, which SeisComP, slarchive, ringserver\n"
      "and ObsPy read. What is there already stays: the same again changes nothing. Exit status: "
      "0\n"
      "done, 1 a stretch is not whole or cannot be read, 2 bad usage or no database.\n"
      "Example: framewatch fleet export --sds archive --database postgresql:///fleet");
  command->add_option("--sds", arguments.root, "folder of the archive; made if missing")
      ->type_name("DIR")
      ->required();
  add_database(command, arguments.database);
  command->add_option("--building", arguments.building, "of this one alone");
  command->add_option("--request", arguments.request, "of this command alone: the page names it");
  commands.set_action(command, [&arguments] { return export_command(arguments); });
}

}  // namespace framewatch::fleet
