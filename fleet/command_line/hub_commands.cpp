#include "fleet/hub/hub_commands.h"

#include <CLI/CLI.hpp>

#include "daemon/command_line/command_list.h"
#include "fleet/command_line/fleet_commands.h"

namespace framewatch::fleet {
namespace {

constexpr int kMaxBuildings = 100'000;

void add_directory(CLI::App* command, std::string& directory) {
  command->add_option("--dir", directory, "of the hub's certificates, of buildings and users.conf")
      ->type_name("DIR")
      ->capture_default_str();
}

void add_reload(CLI::App* command, EnrollArguments& arguments) {
  command
      ->add_option(
          "--reload", arguments.reload,
          "file with the process id of a server that is to read users.conf anew; once for\n"
          "each")
      ->type_name("FILE");
}

}  // namespace

void add_setup(daemon::CommandList& commands) {
  SetupArguments& arguments = commands.arguments<SetupArguments>();
  CLI::App* command =
      commands.add("setup", "make the streams and consumers of a hub, or change what differs");
  command->footer(
      "Says what differs. It asks as the operator: DIR has operator.pem, operator.key and ca.pem\n"
      "(fleet authority).\n"
      "Exit status: 0 as they should be, 1 with --check: something differs, 2 no hub, or it "
      "refused.\n"
      "Example: framewatch fleet setup --hub tls://hub1.example.org:4222 --dir hub");
  command->add_option("--hub", arguments.hub.hubs, "server, tls://HOST:PORT; once for each")
      ->required();
  add_directory(command, arguments.hub.directory);
  command->add_option("--replicas", arguments.replicas, "servers that hold each message")
      ->check(CLI::IsMember({1, 3, 5}))
      ->capture_default_str();
  command->add_option("--buildings", arguments.buildings, "that sizes are for")
      ->check(CLI::Range(1, kMaxBuildings))
      ->capture_default_str();
  command->add_flag("--check", arguments.only_look, "only says what differs");
  commands.set_action(command, [&arguments] { return setup_command(arguments); });
}

void add_authority(daemon::CommandList& commands) {
  AuthorityArguments& arguments = commands.arguments<AuthorityArguments>();
  CLI::App* command = commands.add(
      "authority", "certificates of a hub: its authority, its servers, its own programs");
  command->footer(
      "What is there already stays. ca.key signs buildings: keep it off the servers.\n"
      "Example: framewatch fleet authority --dir hub --server hub1=hub1.example.org,10.0.0.1");
  add_directory(command, arguments.directory);
  command
      ->add_option("--server", arguments.servers,
                   "a server and what it is called by on the network; once for each")
      ->type_name("NAME=HOST,...");
  commands.set_action(command, [&arguments] { return authority_command(arguments); });
}

void add_request(daemon::CommandList& commands) {
  RequestArguments& arguments = commands.arguments<RequestArguments>();
  CLI::App* command =
      commands.add("request", "in a building: its private key, and a request for its certificate");
  command->footer("Example: framewatch fleet request kobe-03");
  command->add_option("BUILDING", arguments.building, "its name at the hub")->required();
  command->add_option("--key", arguments.key, "file for the key, which stays here")
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
      commands.add("enroll", "at the hub: sign a building's request and let the building in");
  command->footer("Example: framewatch fleet enroll kobe-03 fleet.csr --dir hub");
  command->add_option("BUILDING", arguments.building, "its name at the hub")->required();
  command->add_option("REQUEST", arguments.request, "what `fleet request` made")->required();
  add_directory(command, arguments.directory);
  command->add_option("--out", arguments.certificate, "file for the certificate (BUILDING.pem)")
      ->type_name("FILE");
  add_reload(command, arguments);
  commands.set_action(command, [&arguments] { return enroll_command(arguments); });
}

void add_revoke(daemon::CommandList& commands) {
  EnrollArguments& arguments = commands.arguments<EnrollArguments>();
  CLI::App* command = commands.add("revoke", "at the hub: let a building in no longer");
  command->footer(
      "Servers that read users.conf anew disconnect it at once.\n"
      "Example: framewatch fleet revoke kobe-03 --dir hub");
  command->add_option("BUILDING", arguments.building, "its name at the hub")->required();
  add_directory(command, arguments.directory);
  add_reload(command, arguments);
  commands.set_action(command, [&arguments] { return revoke_command(arguments); });
}

}  // namespace framewatch::fleet
