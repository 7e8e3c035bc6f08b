#include <CLI/CLI.hpp>

#include "daemon/command_line/command_list.h"
#include "daemon/commands/check_command.h"
#include "daemon/diagnosis/adopt_command.h"
#include "daemon/diagnosis/diagnose_command.h"
#include "daemon/lab/reproduce_command.h"

namespace framewatch::daemon {

void add_check(CommandList& commands) {
  CheckArguments& arguments = commands.arguments<CheckArguments>();
  CLI::App* command = commands.add(
      "check", "every problem of a configuration at once, and what will be identifiable with it");
  command->footer("Example: framewatch check configs/table_two_story.toml");
  commands.reads_files(command->add_option(
      "CONFIG", arguments.config, "configuration file, or scenario file of simulate (TOML)"));
  add_json(command, arguments.json);
  command->add_flag("--print-options-markdown", arguments.print_options_markdown)->group("");
  command->add_flag("--print-effects-markdown", arguments.print_effects_markdown)->group("");
  commands.set_action(command, [&arguments] {
    if (arguments.config.empty() && !arguments.print_options_markdown &&
        !arguments.print_effects_markdown)
      throw CLI::RequiredError("CONFIG");
    return check_command(arguments);
  });
}

void add_reproduce(CommandList& commands) {
  ReproduceArguments& arguments = commands.arguments<ReproduceArguments>();
  CLI::App* command = commands.add(
      "reproduce",
      "the paper's examples again: its tables and figures, its method against this one");
  command->footer(
      "Writes DIR/report.html and, with all cases, DIR/accuracy.md. The paper's ground motions and "
      "the\nmeasured shaking table are looked for in the folder FRAMEWATCH_DATA; seeded motions "
      "stand in.\n"
      "Cases: table1, table2b, table2c, table2d, noise, denoise, table-test.\n"
      "Exit status: 0 written and every promise kept, 1 one not kept, 2 bad usage.\n"
      "Example: framewatch reproduce --case table1 --out paper");
  command->add_option("--out", arguments.out, "folder for what is written")
      ->required()
      ->type_name("DIR");
  command->add_option("--case", arguments.only, "only this case");
  command->add_option("--seeds", arguments.seeds, "motions of every case")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--threads", arguments.threads, "at once (default: one per core)")
      ->check(CLI::Range(1, 1024));
  command->add_flag("--quiet", arguments.quiet, "only promises that are not kept");
  commands.set_action(command, [&arguments] { return reproduce(arguments); });
}

void add_diagnose(CommandList& commands) {
  DiagnoseArguments& arguments = commands.arguments<DiagnoseArguments>();
  CLI::App* command = commands.add(
      "diagnose",
      "where simulation and measurement disagree, the missing effect's name, the augmented model");
  command->footer(
      "Writes diagnosis.json, report.html and model.toml. Exit status: 0 adequate or explained, 1 "
      "a\n"
      "gap remains, 2 bad usage, configuration or input.\n"
      "Examples:\n"
      "  framewatch diagnose building.toml --train monday.csv --holdout tuesday.csv --out "
      "diagnosis\n"
      "  framewatch diagnose building.toml --event 1795292291750000 --out d");
  add_config(commands, command, arguments.config);
  commands.reads_files(
      command->add_option("--train", arguments.train, "record files and LCM event logs")
          ->type_name("FILE"));
  commands.reads_files(
      command->add_option("--holdout", arguments.holdout, "records of other motions, to judge by")
          ->type_name("FILE"));
  command->add_option("--event", arguments.event,
                      "id of a gap event: the samples stored of it, first half and second half, "
                      "instead of --train and --holdout");
  command->add_option("--out", arguments.out, "directory to write to")
      ->required()
      ->type_name("DIR");
  command->add_option("--without", arguments.without, "effects that are not looked for, by name");
  command->add_option("--force", arguments.component.force,
                      "component test: column with the force on floor 1, N");
  command->add_flag("--displacement", arguments.component.displacement,
                    "component test: floor 1 measures displacement relative to the base, m");
  command
      ->add_flag("--prescribed", arguments.component.prescribed,
                 "component test: the motion is prescribed, the force is what it needs")
      ->needs("--force");
  command->add_option("--threads", arguments.threads, "at most so many; the result is the same")
      ->check(CLI::Range(1, 256));
  command->add_flag("--quiet", arguments.quiet, "no progress, no summary");
  add_max_size(command);
  commands.set_action(command, [&arguments] { return diagnose_command(arguments); });
}

void add_adopt(CommandList& commands) {
  AdoptArguments& arguments = commands.arguments<AdoptArguments>();
  CLI::App* command =
      commands.add("adopt", "puts a model where the gap monitor of a running daemon takes it");
  command->footer("Example: framewatch adopt building.toml d/model.toml");
  command->add_option("CONFIG", arguments.config, "configuration file (TOML) with [gap] model")
      ->required();
  command->add_option("MODEL", arguments.model, "model.toml of framewatch diagnose")->required();
  command->add_flag("--quiet", arguments.quiet, "do not say what it has");
  commands.set_action(command, [&arguments] { return adopt(arguments); });
}

}  // namespace framewatch::daemon
