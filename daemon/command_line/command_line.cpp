// SPDX-License-Identifier: MIT
#include "daemon/command_line/command_line.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <system_error>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include "daemon/base/exit_code.h"
#include "daemon/base/printable.h"
#include "daemon/command_line/command_list.h"
#include "daemon/command_line/option_entries.h"

namespace framewatch::daemon {
namespace {

constexpr const char* kFleetProgram = "framewatch-fleet";

std::string beside_this_program() {
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  return error ? kFleetProgram : (self.parent_path() / kFleetProgram).string();
}

void say(const Program& program, const std::string& problem) {
  fmt::print(stderr, "{} {}\n", toned(Tone::bad, program.name + ":", stderr), problem);
}

/// Returns the name of a command in messages: "run", or "fleet task" for the program "framewatch
/// fleet".
std::string said_name(const Program& program, const std::string& command) {
  const std::size_t space = program.name.find(' ');
  return space == std::string::npos ? command : program.name.substr(space + 1) + " " + command;
}

int bad_usage(const Program& program, const CLI::App& app, const CLI::ParseError& error) {
  const auto chosen = app.get_subcommands();
  if (chosen.empty()) {
    say(program, fmt::format("no command given; run `{} help` for a list", program.name));
    return kBadInput;
  }
  const std::string name = chosen.front()->get_name();
  refuse(said_name(program, name), error.what());
  fmt::print(stderr, "run `{} help {}` for its usage\n", program.name, name);
  return kBadInput;
}

int parse_and_run(const Program& program, int argc, const char* const* argv) {
  CLI::App app{program.description};
  app.name(program.name);
  app.require_subcommand(1);
  app.set_version_flag("--version", FRAMEWATCH_VERSION);
  app.footer(program.footer);
  CommandList commands(app);
  for (const auto add : program.commands) add(commands);

  const std::vector<std::string> problems =
      misspelt(program.name, command_entries(app), std::vector<std::string>(argv + 1, argv + argc));
  for (const std::string& problem : problems) say(program, problem);
  if (!problems.empty()) return kBadInput;

  try {
    app.parse(argc, argv);
    const std::string command = app.get_subcommands().front()->get_name();
    const auto& services = program.services;
    now_runs(said_name(program, command),
             std::find(services.begin(), services.end(), command) != services.end());
    return commands.run_chosen();
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    return bad_usage(program, app, error);
  }
}

}  // namespace

/// Returns true for commands of framewatch-fleet, a separate package because it alone needs NATS
/// and PostgreSQL.
bool is_of_fleet(std::string_view command) {
  return command == "fleet" || command == "uplink";
}

/// Replaces this process by framewatch-fleet, found beside this program or in PATH: `framewatch
/// fleet task` runs `framewatch-fleet task`, `framewatch uplink` runs `framewatch-fleet uplink`.
/// Does not return on success. If the program is not found, prints how to get it and returns
/// kBadInput.
int become_fleet_program(int argc, const char* const* argv) {
  std::string name = kFleetProgram;
  std::vector<std::string> words(argv + (argv[1] == std::string_view("fleet") ? 2 : 1),
                                 argv + argc);
  std::vector<char*> arguments{name.data()};
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  ::execv(beside_this_program().c_str(), arguments.data());
  ::execvp(kFleetProgram, arguments.data());
  return refuse(
      argv[1],
      errno == ENOENT
          ? "needs the program framewatch-fleet; install the Debian package framewatch-fleet"
          : std::string(kFleetProgram) + ": " + std::strerror(errno));
}

void add_fleet(CommandList& commands) {
  commands
      .add("fleet",
           "manage many buildings: archives, a hub, an overview (program framewatch-fleet)")
      ->footer("`framewatch fleet help` lists its commands.");
}

void add_uplink(CommandList& commands) {
  commands
      .add("uplink",
           "send the history of `run` to a hub of many buildings (program framewatch-fleet)")
      ->footer("`framewatch uplink --help` lists its options.");
}

int run_program(const Program& program, int argc, const char* const* argv) {
  prepare_last_resort();
  return run_to_the_end([&] { return parse_and_run(program, argc, argv); });
}

int run_command_line(int argc, const char* const* argv) {
  if (argc > 1 && is_of_fleet(argv[1])) return become_fleet_program(argc, argv);
  const Program program{
      "framewatch",
      "framewatch estimates the stiffness and damping of every frame and floor panel of "
      "a\nbuilding from its accelerometers, while it moves.",
      "The file name - is standard input for reading and standard output for writing.",
      {add_demo,    add_run,      add_replay,      add_diff,   add_compare,   add_repair,
       add_refine,  add_modes,    add_diagnose,    add_adopt,  add_init,      add_check,
       add_convert, add_simulate, add_reproduce,   add_report, add_serve,     add_record,
       add_history, add_status,   add_acknowledge, add_note,   add_tell,      add_selftest,
       add_export,  add_fleet,    add_uplink,      add_help,   add_completion},
      {"run", "serve", "record"}};
  return run_program(program, argc, argv);
}

}  // namespace framewatch::daemon
