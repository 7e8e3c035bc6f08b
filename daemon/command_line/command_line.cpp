#include "daemon/command_line/command_line.h"

#include <CLI/CLI.hpp>

#include "daemon/base/last_resort.h"
#include "daemon/command_line/command_list.h"

namespace framewatch::daemon {

namespace {

/// What systemd starts again after a failure.
bool is_service(const std::string& command) {
  return command == "run" || command == "serve" || command == "record";
}

int parse_and_run(int argc, const char* const* argv) {
  CLI::App app{
      "framewatch: stiffness and damping of every frame and floor panel of a building,\n"
      "from its accelerometers, while it moves."};
  app.name("framewatch");
  app.require_subcommand(1);
  app.set_version_flag("--version", FRAMEWATCH_VERSION);

  CommandList commands(app);
  for (const auto add :  // in the order in which --help lists them
       {add_demo,     add_run,       add_replay,      add_diff,  add_repair,
        add_refine,   add_diagnose,  add_adopt,       add_check, add_convert,
        add_simulate, add_reproduce, add_report,      add_serve, add_record,
        add_history,  add_status,    add_acknowledge, add_tell,  add_selftest})
    add(commands);

  try {
    app.parse(argc, argv);
    const std::string command = app.get_subcommands().front()->get_name();
    now_runs(command, is_service(command));
    return commands.run_chosen();
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
}

}  // namespace

int run_command_line(int argc, const char* const* argv) {
  prepare_last_resort();
  return run_to_the_end([&] { return parse_and_run(argc, argv); });
}

}  // namespace framewatch::daemon
