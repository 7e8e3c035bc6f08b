#include "daemon/command_line/fleet_program.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>

#include "daemon/base/exit_code.h"
#include "daemon/command_line/command_list.h"

namespace framewatch::daemon {
namespace {

constexpr const char* kFleetProgram = "framewatch-fleet";

std::string beside_this_program() {
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  return error ? kFleetProgram : (self.parent_path() / kFleetProgram).string();
}

}  // namespace

bool is_of_fleet(std::string_view command) {
  return command == "fleet" || command == "uplink";
}

int become_fleet_program(int argc, const char* const* argv) {
  std::string name = kFleetProgram;
  std::vector<std::string> words(argv + (argv[1] == std::string_view("fleet") ? 2 : 1),
                                 argv + argc);
  std::vector<char*> arguments{name.data()};
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  ::execv(beside_this_program().c_str(), arguments.data());
  ::execvp(kFleetProgram, arguments.data());
  return refuse(argv[1], errno == ENOENT
                             ? "needs the program framewatch-fleet, which is not here "
                               "(Debian package framewatch-fleet)"
                             : std::string(kFleetProgram) + ": " + std::strerror(errno));
}

void add_fleet(CommandList& commands) {
  commands.add("fleet", "many buildings: archives, a hub, an overview (program framewatch-fleet)")
      ->footer("`framewatch fleet help` lists its commands.");
}

void add_uplink(CommandList& commands) {
  commands.add("uplink", "what `run` keeps, sent to a hub of many buildings (framewatch-fleet)")
      ->footer("`framewatch uplink --help` lists its options.");
}

}  // namespace framewatch::daemon
