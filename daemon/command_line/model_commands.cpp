#include <CLI/CLI.hpp>

#include "daemon/command_line/command_list.h"
#include "daemon/tools/commands/check_command.h"
#include "daemon/tools/diagnosis/adopt_command.h"
#include "daemon/tools/diagnosis/diagnose_command.h"
#include "daemon/tools/init/init_command.h"
#include "daemon/tools/lab/reproduce_command.h"

namespace framewatch::daemon {

namespace {

/// Files of one record, a line each.
void add_records(CLI::App* command, InitAnswers& answers) {
  command
      ->add_option_function<std::vector<std::string>>(
          "--record",
          [&answers](const std::vector<std::string>& files) {
            std::string& all = answers.by_option["record"];
            for (const std::string& file : files) all += (all.empty() ? "" : "\n") + file;
          },
          "record from whose header the channels come; of a station all of its files")
      ->type_name("FILE");
}

}  // namespace

void add_init(CommandList& commands) {
  InitArguments& arguments = commands.arguments<InitArguments>();
  CLI::App* command = commands.add(
      "init", "a first configuration of your building, asked for or from options and a record");
  command->footer(
      "On a terminal it asks what the options do not say. Titles of columns such as base_x, F2-X,\n"
      "\"floor 2 frame y1\" are places where that can be read in one way only; PLACE is 0:x "
      "(base,\n"
      "along x), 2:y1 (floor 2, frame y1), or 2:x where one frame moves along x. The frames that\n"
      "move along x are called y1, y2, ... in order of y, those along y x1, x2, ... in order of "
      "x.\n"
      "Files of strong-motion networks say in their headers where their channels are; PLACE is "
      "then "
      "2,\nroof, base, with a direction 2:x where the header has none, or unused.\n"
      "Exit status: 0 written, 2 not, with everything that is missing.\n"
      "Examples:\n"
      "  framewatch init\n"
      "  framewatch init --record shaken.csv --unit g\n"
      "  framewatch init --record shaken.csv --stories 3 --bays 0x0 --heights 4.2,3.5,3.5 \\\n"
      "    --mass 18000 --channel acc0=0:x\n"
      "  framewatch init --live lcm --stories 5 --bays 1x1 --span-x 10.7 --span-y 15 \\\n"
      "    --heights 3.5 --mass 400kg/m2 --start 0.5Hz --out tower.toml");
  auto& answers = arguments.answers;
  const auto answer = [&](const char* name, const char* what, const char* type) {
    return command
        ->add_option_function<std::string>(
            std::string("--") + name,
            [&answers, name](const std::string& text) { answers.by_option[name] = text; }, what)
        ->type_name(type);
  };
  add_records(command, answers);
  add_record_options(command, answers.record);
  answer("live", "where live samples come from (default with a record: none)", "TEXT")
      ->check(CLI::IsMember({"lcm", "can", "none"}));
  answer("interface", "of the CAN bus (default: can0)", "TEXT");
  answer("dbc", "file that describes the CAN bus", "FILE");
  answer("building", "its name", "TEXT");
  answer("base", "level of a station that is the base (default: ground)", "TEXT")
      ->check(CLI::IsMember({"ground", "basement"}));
  answer("stories", "stories above the base", "INT");
  answer("directions", "that the accelerometers measure (default: both)", "TEXT")
      ->check(CLI::IsMember({"x", "y", "both"}));
  answer("bays", "of the plan, along x and y: 2x1; 0 where one frame stands for all", "TEXT");
  answer("span-x", "spans along x, m: one for all, or a list", "LIST");
  answer("span-y", "spans along y, m", "LIST");
  answer("heights", "of the stories from the bottom, m: one for all, or a list", "LIST");
  answer("plan", "lengths along x and y, m, for sensors that are said to be at its sides: 40x25",
         "TEXT");
  answer("floors", "in their plane (default: flexible; of a station: rigid)", "TEXT")
      ->check(CLI::IsMember({"flexible", "rigid"}));
  answer("mass", "of each floor, kg or with its unit: 18000, 18t, 500kg/m2; or a list", "LIST");
  answer("area", "of a floor, m^2, for a mass in kg/m2 where spans do not give it", "FLOAT");
  answer(
      "start",
      "where tuning starts: a first frequency (1.8Hz), period (0.55s), story stiffness (25MN/m),\n"
      "height (46 Hz m / height), stories (T = 0.1 s a story) or none\n"
      "(default: height; with stories below 2 m: none)",
      "TEXT");
  answer("rate", "samples a second, without a record (default: 100)", "FLOAT");
  answer("titles", "what y1 in a column's title is: the frame y1, or the first one along y", "TEXT")
      ->check(CLI::IsMember({"frames", "directions"}));
  command
      ->add_option("--channel", answers.channels,
                   "where a column is: NAME=PLACE, such as acc3=2:y1")
      ->type_name("TEXT")
      ->allow_extra_args(false);
  command->add_option("--out", arguments.out, "file to write")
      ->type_name("FILE")
      ->capture_default_str();
  command->add_flag("--force", arguments.force, "write over a file that is there");
  command->add_flag("--quiet", arguments.quiet, "do not say what was understood");
  add_max_size(command);
  commands.set_action(command, [&arguments] { return init(arguments); });
}

void add_check(CommandList& commands) {
  CheckArguments& arguments = commands.arguments<CheckArguments>();
  CLI::App* command = commands.add(
      "check", "every problem of a configuration at once, and what will be identifiable with it");
  command->footer("Example: framewatch check configs/table_two_story.toml");
  commands.reads_files(command->add_option(
      "CONFIG", arguments.config, "configuration file, or scenario file of simulate (TOML)"));
  add_json(command, arguments.json);
  command
      ->add_option(
          "--advise", arguments.advise,
          "floors that further sensors would gain most on, at most so many; for a building "
          "with sensors on some floors")
      ->check(CLI::Range(1, 100));
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
      "Writes DIR/report.html and, with all cases or few-sensors, DIR/accuracy.md. The paper's\n"
      "ground motions and the measured shaking table are looked for in the folder "
      "FRAMEWATCH_DATA;\n"
      "seeded motions stand in.\n"
      "Cases: table1, table2b, table2c, table2d, noise, denoise, table-test, few-sensors.\n"
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
      "  framewatch diagnose building.toml --event 1795292291560000 --out d");
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
