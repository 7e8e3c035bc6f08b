#include <CLI/CLI.hpp>

#include "daemon/command_line/command_list.h"
#include "daemon/monitor/history/history_command.h"
#include "daemon/tools/commands/convert_command.h"
#include "daemon/tools/replay/diff_command.h"
#include "daemon/tools/replay/refine_command.h"
#include "daemon/tools/replay/repair_command.h"
#include "daemon/tools/replay/replay_command.h"
#include "daemon/tools/report/report_command.h"
#include "daemon/tools/session/record_command.h"
#include "daemon/tools/simulation/simulate_command.h"

namespace framewatch::daemon {
namespace {

/// Adds options that replay only parts, or at the daemon's pace.
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

void add_simulate(CommandList& commands) {
  SimulateArguments& arguments = commands.arguments<SimulateArguments>();
  CLI::App* command =
      commands.add("simulate", "a virtual building's accelerometers, to LCM, to CAN or to a file");
  command->footer(
      "Examples:\n"
      "  framewatch simulate configs/scenario_table_two_story.toml --out rec.lcmlog\n"
      "  framewatch simulate configs/scenario_paper_table1.toml --lcm --speed 2\n"
      "  framewatch simulate configs/can/scenario_tower.toml --can vcan0");
  commands.reads_files(
      command->add_option("SCENARIO", arguments.scenario, "scenario file (TOML)")->required());
  command->add_option("--out", arguments.out, "file to write: .csv, .csv.gz or .lcmlog")
      ->type_name("FILE");
  CLI::Option* lcm = command->add_option("--lcm", arguments.lcm_url,
                                         "publish live, on this URL or the configuration's");
  lcm->expected(0, 1)->type_name("[URL]");
  CLI::Option* can = command->add_option(
      "--can", arguments.can_interface,
      "send the frames of the configuration's CAN nodes, on this interface or the configuration's");
  can->expected(0, 1)->type_name("[INTERFACE]");
  command->add_option("--speed", arguments.speed, "of --lcm and --can, times real time")
      ->check(CLI::Range(1e-3, 1e6))
      ->capture_default_str();
  command->add_option("--seconds", arguments.seconds, "instead of the scenario's duration")
      ->check(CLI::Range(1e-3, 1e6));
  command->add_option("--truth", arguments.truth, "JSON file to write what is hidden to")
      ->type_name("FILE");
  command->add_flag("--quiet", arguments.quiet, "no progress, no summary");
  add_max_size(command);
  commands.set_action(command, [&arguments, lcm, can] {
    arguments.lcm = lcm->count() > 0;
    arguments.can = can->count() > 0;
    return simulate(arguments);
  });
}

void add_record(CommandList& commands) {
  RecordArguments& arguments = commands.arguments<RecordArguments>();
  CLI::App* command = commands.add(
      "record", "acquisition sessions: raw samples and estimates in logs, and a report at the end");
  command->footer(
      "Checks the channels for 3 s, then records until Ctrl-C, --seconds or --send stop. With\n"
      "--standby it waits for the live page, or for --send from another terminal.\n"
      "Exit status: 0 recorded and reported, 1 not everything, 2 bad usage or configuration.\n"
      "Examples:\n"
      "  framewatch record table.toml --test \"El Centro 30 %\" --operator me --seconds 20\n"
      "  framewatch record table.toml --test sweep --trigger 0.2 --pre-trigger 5 --seconds 20\n"
      "  framewatch record table.toml --standby --out sessions\n"
      "  framewatch record table.toml --send start --test sweep");
  add_config(commands, command, arguments.config);
  add_url(command, arguments.url);
  command->add_option("--out", arguments.out, "folder that gets a folder per session")
      ->type_name("DIR")
      ->capture_default_str();
  SessionRequest& request = arguments.request;
  command->add_option("--test", request.test, "name of the test");
  command->add_option("--operator", request.operator_name, "who makes it");
  command->add_option("--notes", request.notes, "what the next reader should know");
  command->add_option("--seconds", request.length_s, "length after the start or trigger");
  command->add_option("--trigger", request.trigger_mps2,
                      "arm: begin when a base channel is so far from rest, m/s^2");
  CLI::Option* before = command->add_option("--pre-trigger", request.pre_trigger_s,
                                            "seconds stored from before the trigger (default 5)");
  command->add_option("--tap-test", arguments.tap_s,
                      "first wait at most so many seconds for a tap next to every sensor, in the\n"
                      "building's positive direction: tells reversed ones");
  command->add_option("--wait", arguments.wait_s, "seconds to wait for the first samples")
      ->check(CLI::Range(1, 86400))
      ->capture_default_str();
  command->add_flag("--by-name", arguments.by_name,
                    "channels without a source are those that nodes name (channel_table_t)");
  command->add_flag("!--no-check", arguments.check, "begin without the check of the channels");
  command->add_flag("--strict", arguments.strict, "record nothing when a channel has a problem");
  command->add_flag("--standby", arguments.standby, "wait for commands, session after session");
  command
      ->add_option("--send", arguments.send, "tell the recorder that runs: start, arm, tap or stop")
      ->check(CLI::IsMember({"start", "arm", "tap", "stop"}));
  command
      ->add_option("--finish", arguments.finish,
                   "stages and report of a session that was cut off, or whose report failed")
      ->type_name("DIR");
  command
      ->add_option("--reports", arguments.reports,
                   "folder for the report (default: the session's own)")
      ->type_name("DIR");
  command->add_flag("--csv", arguments.csv, "raw samples and estimates as CSV too");
  command->add_flag("--mat", arguments.mat, "raw samples and estimates for MATLAB too");
  command->add_flag("--split", arguments.split, "a raw log for every stage too");
  command->add_flag("!--no-report", arguments.report, "no report at the end");
  command->add_flag("--quiet", arguments.quiet, "only what goes wrong");
  commands.set_action(command, [&arguments, before] {
    if (before->count() == 0 && arguments.request.trigger_mps2 > 0)
      arguments.request.pre_trigger_s = 5;
    return record(arguments);
  });
}

void add_report(CommandList& commands) {
  ReportArguments& arguments = commands.arguments<ReportArguments>();
  CLI::App* command = commands.add(
      "report", "one self-contained page of a session: boxplots, parameters, histories, loops");
  command->footer(
      "With --config and --raw also stages (forced and free vibration side by side),\n"
      "reference-dynamic values, transfer functions, drifts and forces.\n"
      "Example: framewatch report est.lcmlog --config table.toml --raw raw.lcmlog --out r.html");
  commands.reads_files(
      command->add_option("EST", arguments.estimates, "LCM event log of estimates")->required());
  command->add_option("--out", arguments.out, "page to write (default: EST with .html)")
      ->type_name("FILE");
  commands.reads_files(
      command->add_option("--config", arguments.config, "the building's configuration (TOML)")
          ->type_name("FILE"));
  commands.reads_files(
      command
          ->add_option("--raw", arguments.raw,
                       "raw samples: LCM event logs and record files, in order of time")
          ->type_name("FILE"));
  add_record_options(command, arguments.record);
  command
      ->add_option("--floors", arguments.floors,
                   "JSON file for the peaks of every floor and the errors of measured floors left\n"
                   "out in turn (channels on some floors only)")
      ->type_name("FILE");
  command
      ->add_option("--drifts", arguments.drifts,
                   "JSON file for the peak drift of every story with its error, what it may have\n"
                   "done by [fragility], and the placard")
      ->type_name("FILE");
  command->add_option("--title", arguments.title, "of the page");
  command->add_option("--test", arguments.test, "name of the test");
  command->add_option("--operator", arguments.operator_name, "who made it");
  command->add_option("--notes", arguments.notes, "what the next reader should know");
  command
      ->add_option("--session", arguments.session,
                   "session.json of framewatch record: check of the channels, trigger")
      ->type_name("FILE");
  command->add_flag("--quiet", arguments.quiet, "do not print the page's path");
  add_max_size(command);
  commands.set_action(command, [&arguments] { return report(arguments); });
}

void add_convert(CommandList& commands) {
  ConvertArguments& arguments = commands.arguments<ConvertArguments>();
  CLI::App* command = commands.add(
      "convert", "records to LCM event logs or CSV, logs of accelerations or estimates to CSV");
  command->footer(
      "What is read is told from the content, what is written from OUT's ending: .lcmlog, .csv or\n"
      ".csv.gz. Several records of one rate become one log. docs/formats.md has every format.\n"
      "Examples:\n"
      "  framewatch convert rec.csv --config table.toml rec.lcmlog\n"
      "  framewatch convert sheet.csv --unit g --time-unit ms rec.lcmlog\n"
      "  framewatch convert elcentro_NS.dat --unit g elcentro.csv\n"
      "  framewatch convert hachi.txt --unit gal --step 0.01 hachi.lcmlog\n"
      "  framewatch convert ground.csv.gz first.csv.gz second.csv.gz top.csv.gz run.lcmlog\n"
      "  framewatch convert est.lcmlog --boxplot est.csv");
  command
      ->add_option("FILES", arguments.inputs,
                   "IN... OUT: record files or one event log, then the output; - is a standard\n"
                   "stream")
      ->required()
      ->expected(2, 1000)
      ->type_name("");
  add_record_options(command, arguments.record);
  command
      ->add_option("--config", arguments.config,
                   "configuration whose channels say where the columns of their names travel")
      ->type_name("FILE");
  command->add_option("--channel", arguments.channel,
                      "LCM channel to write (default ACCEL) or to read");
  command->add_flag("--boxplot", arguments.boxplot, "boxplot columns beside the estimates");
  command->add_flag("--denoise", arguments.denoise,
                    "the paper's removal of noise on every channel of a record, for comparison");
  command->add_option("--start-us", arguments.start_us, "sensor time of a record's time zero");
  add_max_size(command);
  commands.set_action(
      command, [&arguments] { return convert(arguments); },
      [&arguments, &commands] {
        arguments.out = arguments.inputs.back();
        arguments.inputs.pop_back();
        for (std::string& in : arguments.inputs) commands.reads_file(in);
      });
}

void add_history(CommandList& commands) {
  HistoryArguments& arguments = commands.arguments<HistoryArguments>();
  CLI::App* command = commands.add(
      "history", "what `run` keeps on disk: an overview, summaries, events, raw samples as files");
  command->footer(
      "Times are UTC (2026-11-21T23:15:00Z) or seconds since 1970. Exit status: 0 done, 2 bad\n"
      "usage or input, and nothing written.\n"
      "Examples:\n"
      "  framewatch history building.toml\n"
      "  framewatch history building.toml --last 2d --parameter 'kx_1_*'\n"
      "  framewatch history building.toml --period 3600 --out year.csv.gz\n"
      "  framewatch history building.toml --from 2026-11-21T17:00Z --to 2026-11-21T17:05Z \\\n"
      "    --raw quake.mseed");
  command
      ->add_option("CONFIG_OR_DIR", arguments.place,
                   "configuration file (TOML) with [history], or the directory it names")
      ->required();
  command->add_option("--from", arguments.from, "leave out what is earlier");
  command->add_option("--to", arguments.to, "leave out what is this late or later");
  command->add_option("--last", arguments.last, "only so long before the newest: 90m, 2h, 3d");
  command->add_option("--period", arguments.period_s,
                      "seconds that a summary is of (default: the shortest that fits a screen,\n"
                      "of a file the shortest)");
  command->add_option("--parameter", arguments.parameters, "names, * and ? allowed (default: all)");
  command
      ->add_option("--out", arguments.out,
                   "file for the summaries: .csv, .csv.gz or .mat (MATLAB 5)")
      ->type_name("FILE");
  command
      ->add_option("--raw", arguments.raw,
                   "file for raw samples: .lcmlog, .csv, .csv.gz or .mseed (miniSEED)")
      ->type_name("FILE");
  command->add_option("--channel", arguments.channels, "of the raw samples (default: all)");
  command->add_option("--network", arguments.network, "SEED network code")->capture_default_str();
  command->add_option("--station", arguments.station, "SEED station code")->capture_default_str();
  command->add_flag("--events", arguments.events, "every event instead of summaries");
  command->add_flag("--json", arguments.json, "the overview as a program would read it");
  add_max_size(command);
  commands.set_action(command, [&arguments] { return history(arguments); });
}

}  // namespace framewatch::daemon
