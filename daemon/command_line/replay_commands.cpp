#include <CLI/CLI.hpp>

#include "daemon/command_line/command_list.h"
#include "daemon/tools/replay/diff_command.h"
#include "daemon/tools/replay/refine_command.h"
#include "daemon/tools/replay/repair_command.h"
#include "daemon/tools/replay/replay_command.h"

namespace framewatch::daemon {
namespace {

/// What is replayed in parts, or as the daemon would take it.
void add_parts(CLI::App* command, ReplayArguments& arguments) {
  command->add_flag("--one-pass", arguments.one_pass,
                    "estimate as the samples come, as the daemon does; otherwise the filters are\n"
                    "tuned on the input first, and no window is lost to that. --save-state and\n"
                    "--load-state do so, too");
  command
      ->add_option("--save-state", arguments.save_state,
                   "file to go on from with --load-state: the input goes on elsewhere")
      ->type_name("FILE");
  command
      ->add_option("--load-state", arguments.load_state,
                   "go on where an earlier replay, or the daemon, stopped")
      ->type_name("FILE");
}

}  // namespace

void add_replay(CommandList& commands) {
  ReplayArguments& arguments = commands.arguments<ReplayArguments>();
  CLI::App* command = commands.add(
      "replay", "the estimates of recorded motion, as fast as possible, the same bytes every time");
  command->footer(
      "Exit status: 0 done, and as expected; 1 not as --expect says; 2 bad usage, configuration,\n"
      "expectations or input.\n"
      "Examples:\n"
      "  framewatch replay building.toml monday.lcmlog tuesday.lcmlog.zst --out estimates.lcmlog\n"
      "  framewatch replay building.toml record.csv --json\n"
      "  framewatch replay building.toml golden.lcmlog --expect expected.toml --junit result.xml");
  add_config(commands, command, arguments.config);
  commands.reads_files(
      command
          ->add_option("LOG", arguments.inputs,
                       "LCM event logs, plain or .zst, raw logs of a history, and record files\n"
                       "(CSV), in order of time")
          ->required());
  add_record_options(command, arguments.record);
  command
      ->add_option("--out", arguments.out,
                   "file for the estimates: .lcmlog, .csv, .csv.gz or .mat (MATLAB 5); .sqlite:\n"
                   "their summaries, the tables of a history")
      ->type_name("FILE");
  command->add_flag("--boxplot", arguments.boxplot, "boxplot statistics in .csv and .mat too");
  command
      ->add_option(
          "--floors", arguments.floors,
          "file for the accelerations of every floor and the drift ratios of every story,\n"
          "those without a channel too: .csv or .csv.gz")
      ->type_name("FILE");
  command
      ->add_option("--from", arguments.span.from_s,
                   "leave out what is earlier: seconds after the "
                   "first sample")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--to", arguments.span.to_s, "leave out what is later, likewise")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--speed", arguments.speed,
                   "times real time, by the events' times; pauses of over 10 s are\n"
                   "left out (default: as fast as possible)")
      ->check(CLI::Range(1e-3, 1e6));
  CLI::Option* lcm = command->add_option("--lcm", arguments.lcm_url,
                                         "publish too, on this URL or the configuration's");
  lcm->expected(0, 1)->type_name("[URL]");
  add_parts(command, arguments);
  command->add_option("--expect", arguments.expect, "file that says what must come out (TOML)")
      ->type_name("FILE");
  command
      ->add_option("--write-expect", arguments.write_expect,
                   "make a first such file from what comes out")
      ->type_name("FILE");
  command
      ->add_option("--write-baseline", arguments.write_baseline,
                   "baseline file for [watch] to write, of all windows of the replay")
      ->type_name("FILE");
  command
      ->add_option("--event-reports", arguments.event_reports,
                   "folder for the reports that [event_report] asks for after strong motion")
      ->type_name("DIR");
  command->add_option("--junit", arguments.junit, "file for the result of --expect, as JUnit XML")
      ->type_name("FILE");
  command->add_flag("--salvage", arguments.salvage,
                    "replay what is intact of a damaged log instead of refusing it");
  command->add_flag("--quiet", arguments.quiet, "no progress, no summary");
  command->add_flag("--json", arguments.json, "the summary, and what is not as expected, as JSON");
  add_max_size(command);
  commands.set_action(command, [&arguments, lcm] {
    arguments.lcm = lcm->count() > 0;
    return replay(arguments);
  });
}

void add_diff(CommandList& commands) {
  DiffArguments& arguments = commands.arguments<DiffArguments>();
  CLI::App* command = commands.add(
      "diff", "two logs of estimates, field by field: the first and the worst difference of each");
  command->footer(
      "Exit status: 0 the estimates are the same, byte by byte; 1 they are not; 2 bad usage or "
      "input.\n"
      "Example: framewatch diff yesterday.lcmlog today.lcmlog");
  commands.reads_files(
      command->add_option("A", arguments.a, "LCM event log, plain or .zst")->required());
  commands.reads_files(command->add_option("B", arguments.b, "likewise")->required());
  add_json(command, arguments.json);
  command->add_flag("--quiet", arguments.quiet, "only the exit status");
  add_max_size(command);
  commands.set_action(command, [&arguments] { return diff(arguments); });
}

void add_repair(CommandList& commands) {
  RepairArguments& arguments = commands.arguments<RepairArguments>();
  CLI::App* command =
      commands.add("repair", "every intact event of a damaged log, and what was lost where");
  command->footer(
      "Exit status: 0 nothing was damaged, or a whole log was written; 1 damaged, with --check; 2 "
      "bad\nusage or input. An intact log is left alone and no file is written.\n"
      "Examples:\n"
      "  framewatch repair night.lcmlog --out night.repaired.lcmlog\n"
      "  framewatch repair night.lcmlog --check --json");
  command->add_option("LOG", arguments.log, "LCM event log, plain or .zst")->required();
  command
      ->add_option("--out", arguments.out,
                   "log to write (default: LOG with .repaired before its ending)")
      ->type_name("FILE");
  command->add_flag("--check", arguments.check, "write nothing, only say what is damaged");
  add_json(command, arguments.json);
  add_max_size(command);
  commands.set_action(command, [&arguments] { return repair(arguments); });
}

void add_refine(CommandList& commands) {
  RefineArguments& arguments = commands.arguments<RefineArguments>();
  CLI::App* command = commands.add(
      "refine",
      "maximum-likelihood estimate from one stretch of recorded motion, and the least error\n"
      "(Cramer-Rao bound) that any estimate from it could have");
  command->footer(
      "Exit status: 0 refined, 1 not (too short, quiet, ...), 2 bad usage or input.\n"
      "Example: framewatch refine building.toml record.lcmlog --from 12 --to 22");
  add_config(commands, command, arguments.config);
  commands.reads_files(command
                           ->add_option("LOG", arguments.inputs,
                                        "LCM event logs and record files (CSV), in order of time")
                           ->required());
  add_record_options(command, arguments.record);
  command->add_option("--from", arguments.from_s, "seconds after the first sample")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--to", arguments.to_s, "likewise (default: one window after --from)")
      ->check(CLI::PositiveNumber);
  command->add_flag("!--no-prior", arguments.prior, "without the prior about the design");
  add_json(command, arguments.json);
  add_max_size(command);
  commands.set_action(command, [&arguments] { return refine(arguments); });
}

}  // namespace framewatch::daemon
