// SPDX-License-Identifier: MIT
#include "fleet/hub/hub_commands.h"

#include <CLI/CLI.hpp>

#include "daemon/command_line/command_list.h"
#include "fleet/command_line/fleet_commands.h"

namespace framewatch::fleet {
namespace {

constexpr int kMaxBuildings = 100'000;

void add_directory(CLI::App* command, std::string& directory) {
  command
      ->add_option("--dir", directory,
                   "folder of the certificates, buildings and users.conf of the hub")
      ->type_name("DIR")
      ->capture_default_str();
}

void add_reload(CLI::App* command, EnrollArguments& arguments) {
  command
      ->add_option("--reload", arguments.reload,
                   "file with the process id of a server that must reload users.conf; repeat for\n"
                   "each")
      ->type_name("FILE");
}

}  // namespace

CLI::Option* add_hubs(CLI::App* command, std::vector<std::string>& hubs) {
  return command->add_option("--hub", hubs, "server, tls://HOST:PORT; repeat for each");
}

void add_building(CLI::App* command, std::string& building) {
  command->add_option("BUILDING", building, "name of the building at the hub")->required();
}

void add_setup(daemon::CommandList& commands) {
  SetupArguments& arguments = commands.arguments<SetupArguments>();
  CLI::App* command = commands.add(
      "setup", "create the streams and consumers of a hub, or change those that differ");
  command->footer(
      "Prints the differences. DIR has operator.pem, operator.key and ca.pem (fleet authority).\n"
      "Exit status: 0 correct, 1 with --check: something differs, 2 no hub, or it refused.\n"
      "Example: framewatch fleet setup --hub tls://hub1.example.org:4222 --dir hub");
  add_hubs(command, arguments.hub.hubs)->required();
  add_directory(command, arguments.hub.directory);
  command->add_option("--replicas", arguments.replicas, "number of servers that store each message")
      ->check(CLI::IsMember({1, 3, 5}))
      ->capture_default_str();
  command->add_option("--buildings", arguments.buildings, "number of buildings for the sizes")
      ->check(CLI::Range(1, kMaxBuildings))
      ->capture_default_str();
  command->add_flag("--check", arguments.only_look, "only print the differences");
  commands.set_action(command, [&arguments] { return setup_command(arguments); });
}

void add_authority(daemon::CommandList& commands) {
  AuthorityArguments& arguments = commands.arguments<AuthorityArguments>();
  CLI::App* command = commands.add(
      "authority", "create the certificates of a hub: authority, servers and programs");
  command->footer(
      "Keeps existing files. ca.key signs buildings: keep it off the servers.\n"
      "Example: framewatch fleet authority --dir hub --server hub1=hub1.example.org,10.0.0.1");
  add_directory(command, arguments.directory);
  command
      ->add_option("--server", arguments.servers,
                   "server and its host names and addresses; repeat for each")
      ->type_name("NAME=HOST,...");
  commands.set_action(command, [&arguments] { return authority_command(arguments); });
}

void add_request(daemon::CommandList& commands) {
  RequestArguments& arguments = commands.arguments<RequestArguments>();
  CLI::App* command =
      commands.add("request", "in a building: create a private key and a certificate request");
  command->footer("Example: framewatch fleet request kobe-03");
  add_building(command, arguments.building);
  command->add_option("--key", arguments.key, "file for the private key, which must stay here")
      ->type_name("FILE")
      ->capture_default_str();
  command->add_option("--out", arguments.request, "file for the request")
      ->type_name("FILE")
      ->capture_default_str();
  commands.set_action(command, [&arguments] { return request_command(arguments); });
}

void add_enroll(daemon::CommandList& commands) {
  EnrollArguments& arguments = commands.arguments<EnrollArguments>();
  CLI::App* command =
      commands.add("enroll", "at the hub: sign a building's request and admit the building");
  command->footer("Example: framewatch fleet enroll kobe-03 fleet.csr --dir hub");
  add_building(command, arguments.building);
  command->add_option("REQUEST", arguments.request, "file that `fleet request` wrote")->required();
  add_directory(command, arguments.directory);
  command->add_option("--out", arguments.certificate, "file for the certificate (BUILDING.pem)")
      ->type_name("FILE");
  add_reload(command, arguments);
  commands.set_action(command, [&arguments] { return enroll_command(arguments); });
}

void add_revoke(daemon::CommandList& commands) {
  EnrollArguments& arguments = commands.arguments<EnrollArguments>();
  CLI::App* command = commands.add("revoke", "at the hub: stop admitting a building");
  command->footer(
      "Servers disconnect it as soon as they reload users.conf.\n"
      "Example: framewatch fleet revoke kobe-03 --dir hub");
  add_building(command, arguments.building);
  add_directory(command, arguments.directory);
  add_reload(command, arguments);
  commands.set_action(command, [&arguments] { return revoke_command(arguments); });
}

}  // namespace framewatch::fleet
