// SPDX-License-Identifier: MIT
#include <CLI/CLI.hpp>

#include "daemon/command_line/command_list.h"
#include "daemon/monitor/history/history_command.h"
#include "daemon/tools/commands/convert_command.h"
#include "daemon/tools/compare/compare_command.h"
#include "daemon/tools/replay/diff_command.h"
#include "daemon/tools/replay/refine_command.h"
#include "daemon/tools/replay/repair_command.h"
#include "daemon/tools/replay/replay_command.h"
#include "daemon/tools/report/modes_command.h"
#include "daemon/tools/report/report_command.h"
#include "daemon/tools/session/record_command.h"
#include "daemon/tools/simulation/simulate_command.h"

namespace framewatch::daemon {
namespace {

/// Adds options that replay only parts, or at the daemon's pace.
void add_parts(CLI::App* command, ReplayArguments& arguments) {
  command->add_flag(
      "--one-pass", arguments.one_pass,
      "estimate in one pass like the daemon. By default a first pass tunes the\nfilters, so no "
      "window is lost to that. --save-state and --load-state imply\n--one-pass");
  add_file(command, "--save-state", arguments.save_state,
           "save the state to this file, to continue with --load-state");
  add_file(command, "--load-state", arguments.load_state,
           "continue from the saved state of an earlier replay or of the daemon");
}

/// Adds --about, --figures and --format.
void add_page_options(CLI::App* command, std::string& about, PictureFiles& figures) {
  add_file(command, "--about", about,
           "file for the head of the page: date, laboratory, client, author, photographs (TOML)");
  add_folder(command, "--figures", figures.folder,
             "new folder for every picture as a file, one and two columns wide, with "
             "its\npoints as CSV");
  command
      ->add_option("--format", figures.formats,
                   "formats of these files: svg, pdf, png (needs the package librsvg2-2)")
      ->delimiter(',')
      ->check(CLI::IsMember({"svg", "pdf", "png"}))
      ->default_str("svg");
}

/// Adds CONFIG, LOG, the options of record files, --from and --to. to_default: --to if it is
/// absent.
template <typename Arguments>
void add_stretch(CommandList& commands, CLI::App* command, Arguments& arguments,
                 const std::string& to_default) {
  add_config(commands, command, arguments.config);
  commands.reads_files(command
                           ->add_option("LOG", arguments.inputs,
                                        "LCM event logs and record files (CSV), in order of time")
                           ->required());
  add_record_options(command, arguments.record);
  command->add_option("--from", arguments.from_s, "seconds after the first sample")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command
      ->add_option("--to", arguments.to_s,
                   "seconds after the first sample (default: " + to_default + ")")
      ->check(CLI::PositiveNumber);
}

}  // namespace

void add_replay(CommandList& commands) {
  ReplayArguments& arguments = commands.arguments<ReplayArguments>();
  CLI::App* command = commands.add(
      "replay", "estimate from recorded motion, as fast as possible and reproducible to the byte",
      "Exit status: 0 done and as expected; 1 not as --expect requires; 2 bad usage, "
      "configuration,\nexpectations or input.\nExamples:\n  framewatch replay building.toml "
      "monday.lcmlog tuesday.lcmlog.zst --out estimates.lcmlog\n  framewatch replay building.toml "
      "record.csv --json\n  framewatch replay building.toml golden.lcmlog --expect expected.toml "
      "--junit result.xml");
  add_config(commands, command, arguments.config);
  commands.reads_files(command
                           ->add_option("LOG", arguments.inputs,
                                        "LCM event logs (plain or .zst), raw logs of a history and "
                                        "record files\n(CSV), in order of time")
                           ->required());
  add_record_options(command, arguments.record);
  add_file(command, "--out", arguments.out,
           "file for the estimates: .lcmlog, .csv, .csv.gz or .mat (MATLAB 5); "
           ".sqlite\nfor summaries as in a history");
  command->add_flag("--boxplot", arguments.boxplot,
                    "also write boxplot statistics to .csv and .mat");
  add_file(command, "--floors", arguments.floors,
           "file for the accelerations of every floor and the drift ratios of every "
           "story,\nalso those without a channel: .csv or .csv.gz");
  command
      ->add_option("--from", arguments.span.from_s,
                   "skip earlier samples: seconds after the first sample")
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option("--to", arguments.span.to_s,
                   "skip later samples: seconds after the first sample")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--speed", arguments.speed,
                   "multiple of real time, by the events' times; pauses over 10 s are\nskipped "
                   "(default: as fast as possible)")
      ->check(CLI::Range(1e-3, 1e6));
  CLI::Option* lcm = command->add_option("--lcm", arguments.lcm_url,
                                         "also publish on this URL, or on the configuration's");
  lcm->expected(0, 1)->type_name("[URL]");
  add_parts(command, arguments);
  add_file(command, "--expect", arguments.expect, "file with the expected result (TOML)");
  add_file(command, "--write-expect", arguments.write_expect, "write such a file from the result");
  add_file(command, "--write-baseline", arguments.write_baseline,
           "write a baseline file for [watch] from all windows of the replay");
  add_folder(command, "--event-reports", arguments.event_reports,
             "folder for the reports of [event_report] after strong motion");
  add_file(command, "--junit", arguments.junit,
           "write the result of --expect to this file, as JUnit XML");
  command->add_flag("--salvage", arguments.salvage,
                    "replay the intact part of a damaged log instead of refusing it");
  command->add_flag("--quiet", arguments.quiet, "print no progress and no summary");
  command->add_flag("--json", arguments.json, "print the summary and unexpected results as JSON");
  add_max_size(command);
  commands.set_action(command, [&arguments, lcm] {
    arguments.lcm = lcm->count() > 0;
    return replay(arguments);
  });
}

void add_diff(CommandList& commands) {
  DiffArguments& arguments = commands.arguments<DiffArguments>();
  CLI::App* command = commands.add(
      "diff", "compare two logs of estimates field by field: first and largest difference of each",
      "Exit status: 0 the estimates are the same, byte by byte; 1 they are not; 2 bad usage or "
      "input.\n"
      "Example: framewatch diff yesterday.lcmlog today.lcmlog");
  commands.reads_files(
      command->add_option("A", arguments.a, "LCM event log, plain or .zst")->required());
  commands.reads_files(command->add_option("B", arguments.b, "second log")->required());
  add_json(command, arguments.json);
  command->add_flag("--quiet", arguments.quiet, "print nothing; only set the exit status");
  add_max_size(command);
  commands.set_action(command, [&arguments] { return diff(arguments); });
}

void add_compare(CommandList& commands) {
  CompareArguments& arguments = commands.arguments<CompareArguments>();
  CLI::App* command = commands.add(
      "compare",
      "compare runs of one building: stiffness, damping, modes, drifts and transfer "
      "functions,\nwith "
      "the differences in standard errors",
      "A source is a record file or raw log (with --config), a log of estimates, a folder of\n"
      "`framewatch record`, a configuration (its design), or PLACE@FROM..TO: the history of a\n"
      "configuration or folder between two times (UTC, or seconds since 1970).\nExit status: 0 no "
      "stiffness and no natural frequency differs; 1 one differs, or no\nstiffness could be "
      "judged; "
      "2 bad usage or input, or unlike buildings.\nExamples:\n  framewatch compare run1.csv "
      "run2.csv --config table.toml --out "
      "compare.html\n"
      "  framewatch compare monday.lcmlog friday.lcmlog --threshold 5 --quiet");
  commands.reads_files(command
                           ->add_option("SOURCES", arguments.sources,
                                        "two or more sources; the first is what the others are "
                                        "compared with")
                           ->required()
                           ->expected(2, 1000));
  commands.reads_files(add_file(command, "--config", arguments.options.config,
                                "configuration of record files and raw logs (TOML)"));
  add_record_options(command, arguments.options.record, "--raw-format");
  add_file(command, "--out", arguments.out, "page to write (HTML)");
  add_page_options(command, arguments.about, arguments.figures);
  command
      ->add_option_function<double>(
          "--threshold",
          [&arguments](const double& percent) { arguments.limits.ratio = percent / 100; },
          "least difference of a stiffness, % (default: 3 for frames, 20 for floor panels);\nof a "
          "natural "
          "frequency half of that of a frame")
      ->check(CLI::Range(0.01, 100.0));
  command
      ->add_option("--errors", arguments.limits.errors,
                   "least difference of a stiffness or frequency in standard errors")
      ->check(CLI::Range(1.0, 1000.0))
      ->capture_default_str();
  add_json(command, arguments.json);
  command->add_flag("--quiet", arguments.quiet, "print nothing; only set the exit status");
  add_max_size(command);
  commands.set_action(command, [&arguments] { return compare(arguments); });
}

void add_repair(CommandList& commands) {
  RepairArguments& arguments = commands.arguments<RepairArguments>();
  CLI::App* command = commands.add(
      "repair", "copy every intact event of a damaged log and list what was lost",
      "Exit status: 0 intact, or a repaired log was written; 1 damaged, with --check; 2 bad "
      "usage\nor input. Nothing is written for an intact log.\nExamples:\n  framewatch repair "
      "night.lcmlog --out night.repaired.lcmlog\n  framewatch repair night.lcmlog --check --json");
  command->add_option("LOG", arguments.log, "LCM event log, plain or .zst")->required();
  add_file(command, "--out", arguments.out,
           "log to write (default: LOG with .repaired before its ending)");
  command->add_flag("--check", arguments.check, "write nothing, only list the damage");
  add_json(command, arguments.json);
  add_max_size(command);
  commands.set_action(command, [&arguments] { return repair(arguments); });
}

void add_refine(CommandList& commands) {
  RefineArguments& arguments = commands.arguments<RefineArguments>();
  CLI::App* command = commands.add(
      "refine",
      "compute the maximum-likelihood estimate from one stretch of recorded motion, "
      "with the\nsmallest error that any estimate could have (Cramer-Rao bound)",
      "Exit status: 0 refined, 1 not refined (too short, too quiet, ...), 2 bad usage or "
      "input.\nExample: framewatch refine building.toml record.lcmlog --from 12 --to 22");
  add_stretch(commands, command, arguments, "one window after --from");
  command->add_flag("!--no-prior", arguments.prior, "do not use the design as a prior");
  add_json(command, arguments.json);
  add_max_size(command);
  commands.set_action(command, [&arguments] { return refine(arguments); });
}

void add_modes(CommandList& commands) {
  ModesArguments& arguments = commands.arguments<ModesArguments>();
  CLI::App* command = commands.add(
      "modes",
      "print natural frequencies, damping ratios and shapes: of the model identified from a "
      "record,\nof the record alone, and of the design",
      "Exit status: 0 done, 1 neither model nor record gives a mode, 2 bad usage or "
      "input.\nExamples:\n  framewatch modes building.toml record.csv\n  framewatch modes "
      "building.toml record.lcmlog --from 12 --to 40 --csv modes.csv --mat modes.mat");
  add_stretch(commands, command, arguments, "the end");
  add_file(command, "--csv", arguments.csv, "also write one row per mode, with the shapes, as CSV");
  add_file(command, "--mat", arguments.mat, "also write the modes for MATLAB (MAT 5)");
  add_json(command, arguments.json);
  add_max_size(command);
  commands.set_action(command, [&arguments] { return modes(arguments); });
}

void add_simulate(CommandList& commands) {
  SimulateArguments& arguments = commands.arguments<SimulateArguments>();
  CLI::App* command = commands.add(
      "simulate",
      "simulate a building's accelerometers, or years of its weather, for LCM, CAN or a file",
      "Examples:\n"
      "  framewatch simulate configs/scenario_table_two_story.toml --out rec.lcmlog\n"
      "  framewatch simulate configs/scenario_paper_table1.toml --lcm --speed 2\n"
      "  framewatch simulate configs/can/scenario_tower.toml --can vcan0\n"
      "  framewatch simulate configs/scenario_years.toml --history years");
  commands.reads_files(
      command->add_option("SCENARIO", arguments.scenario, "scenario file (TOML)")->required());
  add_file(command, "--out", arguments.out, "file to write: .csv, .csv.gz or .lcmlog");
  CLI::Option* lcm = command->add_option("--lcm", arguments.lcm_url,
                                         "publish live on this URL, or on the configuration's");
  lcm->expected(0, 1)->type_name("[URL]");
  CLI::Option* can = command->add_option(
      "--can", arguments.can_interface,
      "send the frames of the configured CAN nodes on this interface, or on the configuration's");
  can->expected(0, 1)->type_name("[INTERFACE]");
  command
      ->add_option("--speed", arguments.speed,
                   "speed of --lcm and --can, as a multiple of real time")
      ->check(CLI::Range(1e-3, 1e6))
      ->capture_default_str();
  add_folder(command, "--history", arguments.history,
             "new folder for a history as framewatch run keeps it, from the scenario's [climate]: "
             "years in\nminutes, without motion");
  add_file(command, "--weather", arguments.weather,
           "with --history: write the weather of every hour to this CSV file");
  command->add_option("--seconds", arguments.seconds, "duration, instead of the scenario's")
      ->check(CLI::Range(1e-3, 1e9));
  add_file(command, "--truth", arguments.truth, "write the true values to this JSON file");
  command->add_flag("--quiet", arguments.quiet, "print no progress and no summary");
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
      "record", "record test sessions: logs of raw samples and estimates, and a report at the end",
      "Checks the channels for 3 s, then records until Ctrl-C, --seconds or --send stop. "
      "With\n--standby it waits for commands of the live page or of --send from another "
      "terminal.\nExit status: 0 recorded and reported, 1 incomplete, 2 bad usage or "
      "configuration.\nExamples:\n  framewatch record table.toml --test \"El Centro 30 %\" "
      "--operator me --seconds 20\n  framewatch record table.toml --test sweep --trigger 0.2 "
      "--pre-trigger 5 --seconds 20\n  framewatch record table.toml --standby --out sessions\n  "
      "framewatch record table.toml --send start --test sweep");
  add_config(commands, command, arguments.config);
  add_url(command, arguments.url);
  add_folder(command, "--out", arguments.out, "folder for the sessions, one folder each")
      ->capture_default_str();
  SessionRequest& request = arguments.request;
  command->add_option("--test", request.test, "name of the test");
  command->add_option("--operator", request.operator_name, "operator of the test");
  command->add_option("--notes", request.notes, "notes for the report");
  command->add_option("--seconds", request.length_s, "length after the start or trigger");
  command->add_option("--trigger", request.trigger_mps2,
                      "start when a base channel differs from rest by this much, m/s^2");
  CLI::Option* before = command->add_option("--pre-trigger", request.pre_trigger_s,
                                            "seconds to keep from before the trigger (default 5)");
  command->add_option("--tap-test", arguments.tap_s,
                      "first wait up to this many seconds for a tap next to every sensor, in "
                      "the\nbuilding's positive direction, to find reversed sensors");
  command->add_option("--wait", arguments.wait_s, "seconds to wait for the first samples")
      ->check(CLI::Range(1, 86400))
      ->capture_default_str();
  command->add_flag(
      "--by-name", arguments.by_name,
      "match channels without a source by the names that nodes send (channel_table_t)");
  command->add_flag("!--no-check", arguments.check, "start without checking the channels");
  command->add_flag("--strict", arguments.strict, "do not record if a channel has a problem");
  command->add_flag("--standby", arguments.standby,
                    "wait for commands, for any number of sessions");
  command
      ->add_option("--send", arguments.send,
                   "send a command to the running recorder: start, arm, tap or stop")
      ->check(CLI::IsMember({"start", "arm", "tap", "stop"}));
  add_folder(command, "--finish", arguments.finish,
             "complete a session that was interrupted or whose report failed");
  add_folder(command, "--reports", arguments.reports,
             "folder for the report (default: the session's folder)");
  command->add_flag("--csv", arguments.csv, "also write raw samples and estimates as CSV");
  command->add_flag("--mat", arguments.mat, "also write raw samples and estimates for MATLAB");
  command->add_flag("--split", arguments.split, "also write a raw log per stage");
  command->add_flag("!--no-report", arguments.report, "write no report");
  command->add_flag("--quiet", arguments.quiet, "print only errors and warnings");
  commands.set_action(command, [&arguments, before] {
    if (before->count() == 0 && arguments.request.trigger_mps2 > 0)
      arguments.request.pre_trigger_s = 5;
    return record(arguments);
  });
}

void add_report(CommandList& commands) {
  ReportArguments& arguments = commands.arguments<ReportArguments>();
  CLI::App* command = commands.add(
      "report",
      "write a self-contained page about a session: boxplots, parameters, histories, loops",
      "With --config and --raw, it also shows stages (forced and free vibration side by "
      "side),\nreference-dynamic values, transfer functions, modes, drifts and "
      "forces.\nExamples:\n  "
      "framewatch report est.lcmlog --config table.toml --raw raw.lcmlog --out r.html\n  "
      "framewatch report est.lcmlog --figures figures --format pdf,png");
  commands.reads_files(
      command->add_option("EST", arguments.estimates, "LCM event log of estimates")->required());
  add_file(command, "--out", arguments.out, "page to write (default: EST with .html)");
  commands.reads_files(
      add_file(command, "--config", arguments.config, "the building's configuration (TOML)"));
  commands.reads_files(
      command
          ->add_option("--raw", arguments.raw,
                       "raw samples: LCM event logs and record files, in order of time")
          ->type_name("FILE"));
  add_record_options(command, arguments.record, "--raw-format");  // --format: of pictures
  add_file(command, "--floors", arguments.floors,
           "JSON file for the peaks of every floor, and the errors when measured "
           "floors\nare left out in turn (channels on some floors only)");
  add_file(command, "--drifts", arguments.drifts,
           "JSON file for the peak drift of every story with its error, its "
           "probable\ndamage by [fragility], and the placard");
  add_page_options(command, arguments.about, arguments.figures);
  command->add_option("--title", arguments.title, "title of the page");
  command->add_option("--test", arguments.test, "name of the test");
  command->add_option("--operator", arguments.operator_name, "operator of the test");
  command->add_option("--notes", arguments.notes, "notes for the report");
  add_file(command, "--session", arguments.session,
           "session.json of `framewatch record`, with the channel check and the trigger");
  command->add_flag("--quiet", arguments.quiet, "do not print the page's path");
  add_max_size(command);
  commands.set_action(command, [&arguments] { return report(arguments); });
}

void add_convert(CommandList& commands) {
  ConvertArguments& arguments = commands.arguments<ConvertArguments>();
  CLI::App* command = commands.add(
      "convert", "convert records to LCM event logs or CSV, and logs to CSV",
      "The content decides how a file is read. OUT's ending decides what is written: .lcmlog, "
      ".csv\nor .csv.gz. Several records of one rate become one log. docs/formats.md lists the "
      "formats.\nExamples:\n  framewatch convert rec.csv --config table.toml rec.lcmlog\n  "
      "framewatch convert sheet.csv --unit g --time-unit ms rec.lcmlog\n  framewatch convert "
      "elcentro_NS.dat --unit g elcentro.csv\n  framewatch convert hachi.txt --unit gal --step "
      "0.01 hachi.lcmlog\n  framewatch convert ground.csv.gz first.csv.gz second.csv.gz top.csv.gz "
      "run.lcmlog\n  framewatch convert est.lcmlog --boxplot est.csv");
  command
      ->add_option("FILES", arguments.inputs,
                   "IN... OUT: record files or one event log, then the output; - is a standard\n"
                   "stream")
      ->required()
      ->expected(2, 1000)
      ->type_name("");
  add_record_options(command, arguments.record);
  add_file(command, "--config", arguments.config,
           "configuration whose channels give the LCM channel and node of equally named columns");
  command->add_option("--channel", arguments.channel,
                      "LCM channel to write (default ACCEL) or to read");
  command->add_flag("--boxplot", arguments.boxplot, "also write boxplot columns");
  command->add_flag("--denoise", arguments.denoise,
                    "apply the paper's noise removal to every channel of a record, for comparison");
  command->add_option("--start-us", arguments.start_us, "sensor time of the record's time zero");
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
      "history", "read what `run` keeps on disk: an overview, summaries, events, raw samples",
      "Times are UTC (2026-11-21T23:15:00Z) or seconds since 1970.\nExit status: 0 done; 1 "
      "--losses or --report found one; 2 bad usage or input; nothing is written.\nExamples:\n  "
      "framewatch "
      "history building.toml\n  "
      "framewatch history building.toml --last 2d --parameter 'kx_1_*'\n  framewatch history "
      "building.toml --period 3600 --out year.csv.gz\n  framewatch history building.toml --from "
      "2026-11-21T17:00Z --to 2026-11-21T17:05Z \\\n    --raw quake.mseed");
  command
      ->add_option("CONFIG_OR_DIR", arguments.place,
                   "configuration file (TOML) with [history], or the directory it names")
      ->required();
  command->add_option("--from", arguments.from, "skip earlier data");
  command->add_option("--to", arguments.to, "skip data from this time on");
  command->add_option("--last", arguments.last,
                      "only this long before the newest data: 90m, 2h, 3d");
  command->add_option("--period", arguments.period_s,
                      "seconds per summary (default: the shortest that fits the screen; for "
                      "a\nfile, the shortest)");
  command->add_option("--parameter", arguments.parameters,
                      "names of parameters, with * and ? (default: all)");
  add_file(command, "--out", arguments.out,
           "file for the summaries: .csv, .csv.gz or .mat (MATLAB 5)");
  add_file(command, "--raw", arguments.raw,
           "file for raw samples: .lcmlog, .csv, .csv.gz or .mseed (miniSEED)");
  command->add_option("--channel", arguments.channels,
                      "channels of the raw samples (default: all)");
  command->add_option("--network", arguments.network, "SEED network code")->capture_default_str();
  command->add_option("--station", arguments.station, "SEED station code")->capture_default_str();
  command->add_flag("--events", arguments.events, "list every event instead of summaries");
  command->add_flag("--losses", arguments.losses,
                    "look in months or years of daily means for lasting losses that weather does "
                    "not\nexplain");
  add_file(
      command, "--report", arguments.report,
      "file for a page about months or years: losses, every frame day by day, weather, events");
  add_file(command, "--weather", arguments.weather,
           "table (CSV) for --losses and --report: time, then temperatures (NAME_degc), humidity "
           "(NAME_pct),\nwind (NAME_mps), sun (NAME_wpm2) (default: what the history keeps)");
  add_file(command, "--weather-out", arguments.weather_out,
           "file for the kept weather, hour by hour: .csv or .csv.gz");
  command->add_flag("--json", arguments.json, "print the overview or the losses as JSON");
  add_max_size(command);
  commands.set_action(command, [&arguments] { return history(arguments); });
}

}  // namespace framewatch::daemon
