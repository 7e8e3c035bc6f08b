#include <CLI/CLI.hpp>

#include "daemon/command_line/command_list.h"
#include "fleet/archive/manifest_command.h"
#include "fleet/archive/task_command.h"
#include "fleet/command_line/fleet_commands.h"

namespace framewatch::fleet {

void add_manifest(daemon::CommandList& commands) {
  ManifestArguments& arguments = commands.arguments<ManifestArguments>();
  CLI::App* command = commands.add(
      "manifest", "an archive of raw logs as tasks, one a line, for `framewatch fleet task`");
  command->footer(
      "Each line: number, key, configuration, output, three times (microseconds), logs, with tabs\n"
      "between them. Exit status: 0 done, 2 bad usage, configuration or logs.\n"
      "Examples:\n"
      "  framewatch fleet manifest building.toml out history > manifest.tsv\n"
      "  framewatch fleet manifest building.toml out logs/*.lcmlog.zst --hours 24 > manifest.tsv");
  command->add_option("CONFIG", arguments.config, "configuration file (TOML)")->required();
  command->add_option("OUT", arguments.folder, "folder for what the tasks write; made if missing")
      ->required();
  command
      ->add_option("LOG", arguments.places,
                   "raw logs of a history, directories of histories, or LCM event logs")
      ->required();
  command->add_option("--hours", arguments.hours, "of sensor time that a task stores")
      ->check(CLI::Range(1, 8784))
      ->capture_default_str();
  command
      ->add_option("--warm-up", arguments.warm_up_s,
                   "seconds of samples before it, in which filters and tuning settle")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
  commands.set_action(command, [&arguments] { return manifest(arguments); });
}

void add_task(daemon::CommandList& commands) {
  TaskArguments& arguments = commands.arguments<TaskArguments>();
  CLI::App* command = commands.add(
      "task", "tasks of a manifest: logs in, summaries out, once, however often it is asked");
  command->footer(
      "OUT/TIME.sqlite has the tables of a history, OUT/TIME.json the line that is printed. What "
      "is\n"
      "done is not done again: the key in that line says so. Exit status: 0 done, 1 one failed, 2\n"
      "bad usage or manifest.\n"
      "Examples:\n"
      "  framewatch fleet task manifest.tsv 1 2 3\n"
      "  parallel --joblog run.log --resume-failed framewatch fleet task manifest.tsv {} ::: \\\n"
      "    $(seq $(wc -l < manifest.tsv))");
  command->add_option("MANIFEST", arguments.manifest, "file that `framewatch fleet manifest` wrote")
      ->required();
  command->add_option("N", arguments.numbers, "numbers of tasks")->required();
  commands.set_action(command, [&arguments] { return task(arguments); });
}

}  // namespace framewatch::fleet
