// SPDX-License-Identifier: MIT
#include "fleet/command_line/fleet_command_line.h"

#include <CLI/CLI.hpp>

#include "daemon/command_line/command_line.h"
#include "daemon/command_line/command_list.h"
#include "fleet/archive/manifest_command.h"
#include "fleet/archive/task_command.h"
#include "fleet/command_line/fleet_commands.h"
#include "fleet/uplink/uplink_command.h"

namespace framewatch::fleet {

void add_uplink(daemon::CommandList& commands) {
  UplinkArguments& arguments = commands.arguments<UplinkArguments>();
  CLI::App* command =
      commands.add("uplink", "send the history of a building to the hub, beside `framewatch run`");
  command->footer(
      "CONFIG needs the sections [fleet] and [history]. Data that the hub has not acknowledged\n"
      "stays in the history, however long the hub is away. `framewatch run` does not depend on\n"
      "the hub.\n"
      "Exit status: 0 stopped, 1 no LCM, 2 bad usage, configuration or certificate.\n"
      "Example: framewatch uplink /etc/framewatch/building.toml");
  daemon::add_config(commands, command, arguments.config);
  daemon::add_url(command, arguments.url);
  command->add_flag("--quiet", arguments.quiet, "log only problems");
  commands.set_action(command, [&arguments] { return uplink_command(arguments); });
}

void add_manifest(daemon::CommandList& commands) {
  ManifestArguments& arguments = commands.arguments<ManifestArguments>();
  CLI::App* command = commands.add(
      "manifest", "split an archive of raw logs into tasks for `framewatch fleet task`");
  command->footer(
      "Prints one task a line, with tabs between number, key, configuration, output, three times\n"
      "(microseconds) and logs. Exit status: 0 done, 2 bad usage, configuration or logs.\n"
      "Examples:\n"
      "  framewatch fleet manifest building.toml out history > manifest.tsv\n"
      "  framewatch fleet manifest building.toml out logs/*.lcmlog.zst --hours 24 > manifest.tsv");
  command->add_option("CONFIG", arguments.config, "configuration file (TOML)")->required();
  command
      ->add_option("OUT", arguments.folder,
                   "folder for the outputs of the tasks; created if missing")
      ->required();
  command
      ->add_option("LOG", arguments.places,
                   "raw logs of a history, directories of histories, or LCM event logs")
      ->required();
  command->add_option("--hours", arguments.hours, "hours of sensor time that a task stores")
      ->check(CLI::Range(1, 8784))
      ->capture_default_str();
  command
      ->add_option("--warm-up", arguments.warm_up_s,
                   "seconds of samples before that, in which filters and tuning settle")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
  commands.set_action(command, [&arguments] { return manifest(arguments); });
}

void add_task(daemon::CommandList& commands) {
  TaskArguments& arguments = commands.arguments<TaskArguments>();
  CLI::App* command =
      commands.add("task", "run tasks of a manifest that are not done: logs in, summaries out");
  command->footer(
      "OUT/TIME.sqlite has the tables of a history, OUT/TIME.json the printed line, whose key\n"
      "marks the task as done. Exit status: 0 done, 1 a task failed, 2 bad usage or manifest.\n"
      "Examples:\n"
      "  framewatch fleet task manifest.tsv 1 2 3\n"
      "  parallel --joblog run.log --resume-failed framewatch fleet task manifest.tsv {} ::: \\\n"
      "    $(seq $(wc -l < manifest.tsv))");
  command->add_option("MANIFEST", arguments.manifest, "file that `framewatch fleet manifest` wrote")
      ->required();
  command->add_option("N", arguments.numbers, "numbers of the tasks to run")->required();
  commands.set_action(command, [&arguments] { return task(arguments); });
}

int run_fleet_command_line(int argc, const char* const* argv) {
  const daemon::Program program{"framewatch fleet",
                                "framewatch fleet: many buildings, each with its own framewatch.",
                                "`framewatch uplink` is `framewatch fleet uplink`.",
                                {add_manifest, add_task, add_uplink, add_setup, add_authority,
                                 add_request, add_enroll, add_revoke, add_worker, add_fleet_serve,
                                 add_person, add_describe, add_export, daemon::add_help},
                                {"uplink", "worker", "serve"}};
  return daemon::run_program(program, argc, argv);
}

}  // namespace framewatch::fleet
