#include "daemon/command_line/command_line.h"

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include "daemon/base/exit_code.h"
#include "daemon/base/last_resort.h"
#include "daemon/base/terminal_colour.h"
#include "daemon/command_line/command_list.h"
#include "daemon/command_line/option_entries.h"

namespace framewatch::daemon {

namespace {

/// What systemd starts again after a failure.
bool is_service(const std::string& command) {
  return command == "run" || command == "serve" || command == "record";
}

void say(const std::string& problem) {
  fmt::print(stderr, "{} {}\n", toned(Tone::bad, "framewatch:", stderr), problem);
}

int bad_usage(const CLI::App& app, const CLI::ParseError& error) {
  const auto chosen = app.get_subcommands();
  if (chosen.empty()) {
    say("which command? `framewatch help` lists them");
    return kBadInput;
  }
  const std::string name = chosen.front()->get_name();
  refuse(name, error.what());
  fmt::print(stderr, "`framewatch help {}` says how it is used\n", name);
  return kBadInput;
}

int parse_and_run(int argc, const char* const* argv) {
  CLI::App app{
      "framewatch: stiffness and damping of every frame and floor panel of a building,\n"
      "from its accelerometers, while it moves."};
  app.name("framewatch");
  app.require_subcommand(1);
  app.set_version_flag("--version", FRAMEWATCH_VERSION);

  app.footer(
      "A file called - is standard input where one is read, standard output where one is written.");

  CommandList commands(app);
  for (const auto add :  // in the order in which --help lists them
       {add_demo,        add_run,    add_replay,   add_diff,   add_repair,    add_refine,
        add_diagnose,    add_adopt,  add_init,     add_check,  add_convert,   add_simulate,
        add_reproduce,   add_report, add_serve,    add_record, add_history,   add_status,
        add_acknowledge, add_tell,   add_selftest, add_help,   add_completion})
    add(commands);

  const std::vector<std::string> problems =
      misspelt(command_entries(app), std::vector<std::string>(argv + 1, argv + argc));
  for (const std::string& problem : problems) say(problem);
  if (!problems.empty()) return kBadInput;

  try {
    app.parse(argc, argv);
    const std::string command = app.get_subcommands().front()->get_name();
    now_runs(command, is_service(command));
    return commands.run_chosen();
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    return bad_usage(app, error);
  }
}

}  // namespace

int run_command_line(int argc, const char* const* argv) {
  prepare_last_resort();
  return run_to_the_end([&] { return parse_and_run(argc, argv); });
}

}  // namespace framewatch::daemon
