// SPDX-License-Identifier: MIT
#include <CLI/CLI.hpp>

#include "daemon/command_line/command_list.h"
#include "daemon/tools/commands/check_command.h"
#include "daemon/tools/diagnosis/adopt_command.h"
#include "daemon/tools/diagnosis/diagnose_command.h"
#include "daemon/tools/export/export_command.h"
#include "daemon/tools/init/init_command.h"
#include "daemon/tools/lab/reproduce_command.h"

namespace framewatch::daemon {

namespace {

/// Adds the option of a record's files, joined by line breaks.
void add_records(CLI::App* command, InitAnswers& answers) {
  command
      ->add_option_function<std::vector<std::string>>(
          "--record",
          [&answers](const std::vector<std::string>& files) {
            std::string& all = answers.by_option["record"];
            for (const std::string& file : files) all += (all.empty() ? "" : "\n") + file;
          },
          "record whose header describes the channels; for a station, all of its files")
      ->type_name("FILE");
}

constexpr const char* kInitFooter =
    "On a terminal it asks for what the options leave open. Unambiguous column titles such as\n"
    "base_x, F2-X or \"floor 2 frame y1\" give the place of a channel. PLACE is 0:x (base, along "
    "x),\n"
    "2:y1 (floor 2, frame y1), or 2:x if only one frame moves along x. Frames that move along x\n"
    "are called y1, y2, ... in order of y; those that move along y are x1, x2, ... in order of x.\n"
    "Files of strong-motion networks have the places in their headers. PLACE is then 2, roof, "
    "base\n"
    "or unused, or 2:x if the header has no direction.\n"
    "Few accelerometers are enough on rigid floors, and not every floor needs one: --sensors "
    "names\n"
    "the floors, --per-level the channels of each. Or PLACE is 1@(0,2.5):x, a floor and meters in\n"
    "plan; 1@(0,2.5):xyz for a sensor with three axes.\n"
    "Exit status: 0 written, 2 not written; everything missing is listed.\n"
    "Examples:\n"
    "  framewatch init\n"
    "  framewatch init --live none --stories 12 --sensors 0,4,8,12 --per-level xxy --span-x 30 \\\n"
    "    --span-y 18 --heights 3.6 --mass 600kg/m2 --out twelve.toml\n"
    "  framewatch init --record shaken.csv --unit g\n"
    "  framewatch init --record shaken.csv --stories 3 --bays 0x0 --heights 4.2,3.5,3.5 \\\n"
    "    --mass 18000 --channel acc0=0:x\n"
    "  framewatch init --live lcm --stories 5 --bays 1x1 --span-x 10.7 --span-y 15 \\\n"
    "    --heights 3.5 --mass 400kg/m2 --start 0.5Hz --out tower.toml";

}  // namespace

void add_init(CommandList& commands) {
  InitArguments& arguments = commands.arguments<InitArguments>();
  CLI::App* command = commands.add(
      "init",
      "write a first configuration of your building, by questions or from options and a record",
      kInitFooter);
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
  answer("live", "source of live samples (default with a record: none)", "TEXT")
      ->check(CLI::IsMember({"lcm", "can", "none"}));
  answer("interface", "interface of the CAN bus (default: can0)", "TEXT");
  answer("dbc", "DBC file of the CAN bus", "FILE");
  answer("building", "name of the building", "TEXT");
  answer("base", "level of a station to use as the base (default: ground)", "TEXT")
      ->check(CLI::IsMember({"ground", "basement"}));
  answer("stories", "number of stories above the base", "INT");
  answer("directions", "directions that the accelerometers measure (default: both)", "TEXT")
      ->check(CLI::IsMember({"x", "y", "both"}));
  answer("bays", "bays of the plan along x and y: 2x1; 0 if one frame stands for all", "TEXT");
  answer("span-x", "spans along x, m: one for all, or a list", "LIST");
  answer("span-y", "spans along y, m", "LIST");
  answer("heights", "story heights from the bottom, m: one for all, or a list", "LIST");
  answer("plan", "lengths along x and y, m, for sensors given by the building's sides: 40x25",
         "TEXT");
  answer("floors",
         "stiffness of the floors in their plane (default: flexible; with --per-level, places in "
         "plan or\na station: rigid)",
         "TEXT")
      ->check(CLI::IsMember({"flexible", "rigid"}));
  answer("sensors", "floors with accelerometers, 0 is the base: all (default) or 0,4,8,12", "LIST");
  answer(
      "per-level",
      "channels of each of these floors: frames (default), one on every frame; or xxy: two along "
      "x,\non the first and the last frame, one along y",
      "TEXT");
  answer("mass", "mass of each floor, kg or with a unit: 18000, 18t, 500kg/m2; or a list", "LIST");
  answer("area", "area of a floor, m^2, for a mass in kg/m2 without spans", "FLOAT");
  answer("start",
         "start of the tuning: a first frequency (1.8Hz), period (0.55s), story stiffness "
         "(25MN/m),\nheight (46 Hz m / height), stories (T = 0.1 s per story) or none\n(default: "
         "height; with stories below 2 m: none)",
         "TEXT");
  answer("rate", "samples per second, without a record (default: 100)", "FLOAT");
  answer("titles", "meaning of y1 in a column title: the frame y1, or the first channel along y",
         "TEXT")
      ->check(CLI::IsMember({"frames", "directions"}));
  command
      ->add_option("--channel", answers.channels,
                   "place of a column: NAME=PLACE, such as acc3=2:y1")
      ->type_name("TEXT")
      ->allow_extra_args(false);
  add_file(command, "--out", arguments.out, "file to write")->capture_default_str();
  add_file(command, "--drawing", arguments.drawing, "SVG file to draw floors and plan into");
  command->add_flag("--force", arguments.force, "overwrite an existing file");
  command->add_flag("--quiet", arguments.quiet, "do not print how the answers were understood");
  add_max_size(command);
  commands.set_action(command, [&arguments] { return init(arguments); });
}

void add_export(CommandList& commands) {
  ExportArguments& arguments = commands.arguments<ExportArguments>();
  CLI::App* command = commands.add(
      "export", "write a model for OpenSees, or as mass, damping and stiffness matrices",
      "The model is the design of CONFIG and its effects, such as model.toml of `framewatch "
      "diagnose`.\nAn effect that OpenSees or a matrix cannot hold is refused by name.\nExit "
      "status: 0 written, 2 nothing written.\nExample: framewatch export diagnosis/model.toml "
      "--opensees opensees");
  add_config(commands, command, arguments.config);
  add_folder(command, "--opensees", arguments.opensees,
             "folder for model.tcl and model.py, scripts of OpenSees");
  add_folder(command, "--matrices", arguments.matrices,
             "folder for M, C and K (Matrix Market, MATLAB) and rows.csv, the meaning of each row");
  command->add_option("--without", arguments.without, "names of effects to leave out");
  command->add_flag("--force", arguments.force, "write into folders that are not empty");
  command->add_flag("--quiet", arguments.quiet, "print only problems");
  commands.set_action(command, [&arguments] { return export_command(arguments); });
}

void add_check(CommandList& commands) {
  CheckArguments& arguments = commands.arguments<CheckArguments>();
  CLI::App* command =
      commands.add("check", "list every problem of a configuration and what it can identify",
                   "Example: framewatch check configs/table_two_story.toml");
  commands.reads_files(
      command->add_option("CONFIG", arguments.config,
                          "configuration file, or scenario file of `framewatch simulate` (TOML)"));
  add_json(command, arguments.json);
  command
      ->add_option("--advise", arguments.advise,
                   "list up to this many floors where further sensors would help most; for a "
                   "building with sensors on some floors")
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
      "reproduce", "reproduce the paper's tables and figures and compare its method with this one",
      "Writes DIR/report.html and, with all cases or few-sensors, DIR/accuracy.md. Reads "
      "the\npaper's ground motions and the measured shaking table from the folder "
      "FRAMEWATCH_DATA;\nwithout them it uses seeded motions.\nCases: table1, table2b, table2c, "
      "table2d, noise, denoise, table-test, few-sensors.\nExit status: 0 written and every promise "
      "kept, 1 a promise not kept, 2 bad usage.\nExample: framewatch reproduce --case table1 --out "
      "paper");
  command->add_option("--out", arguments.out, "output folder")->required()->type_name("DIR");
  command->add_option("--case", arguments.only, "run only this case");
  command->add_option("--seeds", arguments.seeds, "number of motions per case")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--threads", arguments.threads, "number of threads (default: one per core)")
      ->check(CLI::Range(1, 1024));
  command->add_flag("--quiet", arguments.quiet, "print only promises that are not kept");
  commands.set_action(command, [&arguments] { return reproduce(arguments); });
}

constexpr double kDiagnoseLimit_s = 300;  ///< as long as a person waits for an answer

void add_diagnose(CommandList& commands) {
  DiagnoseArguments& arguments = commands.arguments<DiagnoseArguments>();
  CLI::App* command = commands.add(
      "diagnose",
      "find where simulation and measurement disagree, name the missing effect, extend the model",
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
  commands.reads_files(command
                           ->add_option("--holdout", arguments.holdout,
                                        "records of other motions, to validate the result")
                           ->type_name("FILE"));
  add_folder(command, "--design", arguments.design,
             "start from the design in the matrices M.mtx, C.mtx and K.mtx of this folder, with "
             "rows as\n`framewatch export --matrices` writes them");
  command->add_option("--event", arguments.event,
                      "id of a gap event: use the two halves of its stored samples instead of "
                      "--train and --holdout");
  command->add_option("--out", arguments.out, "output folder")->required()->type_name("DIR");
  command->add_option("--without", arguments.without, "names of effects to leave out");
  command
      ->add_option("--setting", arguments.settings,
                   "change a number of the search, such as min_gain=100, to see if the result "
                   "depends\non it; docs/lab/sensitivity.md lists them")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  command->add_option("--force", arguments.component.force,
                      "component test: column with the force on floor 1, N");
  command->add_flag("--displacement", arguments.component.displacement,
                    "component test: floor 1 measures displacement relative to the base, m");
  command
      ->add_flag("--prescribed", arguments.component.prescribed,
                 "component test: the motion is prescribed and the force is measured")
      ->needs("--force");
  command
      ->add_option("--threads", arguments.threads,
                   "largest number of threads; does not change the result")
      ->check(CLI::Range(1, 256));
  arguments.limit_s = kDiagnoseLimit_s;
  command
      ->add_option(
          "--limit", arguments.limit_s,
          "longest time, s: the search ends with what it has found, and says what it\ndid not "
          "do (default 300; 0: no limit)")
      ->type_name("SECONDS")
      ->check(CLI::Range(0.0, 1e6))
      ->envname("FRAMEWATCH_DIAGNOSE_LIMIT");
  command->add_flag("--quiet", arguments.quiet, "print no progress and no summary");
  add_max_size(command);
  commands.set_action(command, [&arguments] { return diagnose_command(arguments); });
}

void add_adopt(CommandList& commands) {
  AdoptArguments& arguments = commands.arguments<AdoptArguments>();
  CLI::App* command =
      commands.add("adopt", "install a model for the gap monitor of a running daemon",
                   "Example: framewatch adopt building.toml d/model.toml");
  command->add_option("CONFIG", arguments.config, "configuration file (TOML) with [gap] model")
      ->required();
  command->add_option("MODEL", arguments.model, "model.toml of `framewatch diagnose`")->required();
  command->add_flag("--quiet", arguments.quiet, "do not print what the model has");
  commands.set_action(command, [&arguments] { return adopt(arguments); });
}

}  // namespace framewatch::daemon
