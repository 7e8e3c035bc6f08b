#include <functional>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include "daemon/acknowledge_command.h"
#include "daemon/adopt_command.h"
#include "daemon/check_command.h"
#include "daemon/convert_command.h"
#include "daemon/demo_command.h"
#include "daemon/diagnose_command.h"
#include "daemon/diff_command.h"
#include "daemon/history_command.h"
#include "daemon/record_command.h"
#include "daemon/refine_command.h"
#include "daemon/repair_command.h"
#include "daemon/replay_command.h"
#include "daemon/report_command.h"
#include "daemon/reproduce_command.h"
#include "daemon/run_command.h"
#include "daemon/selftest_command.h"
#include "daemon/serve_command.h"
#include "daemon/simulate_command.h"
#include "daemon/status_command.h"
#include "daemon/tell_command.h"

// The one translation unit that sees CLI11 (it costs seconds to compile): it turns the command line
// into plain argument structs; every command lives in its own file.
namespace {

using namespace framewatch::daemon;

/// What the chosen subcommand will do; set by its CLI11 callback.
using Action = std::function<int()>;

void add_demo(CLI::App& app, Action& action, DemoArguments& arguments) {
  CLI::App* command = app.add_subcommand(
      "demo",
      "a virtual two-story shaking-table test over LCM, with a live page and a table of truth");
  command
      ->add_option("--can", arguments.can,
                   "interface that carries the samples, as frames; no page then")
      ->type_name("INTERFACE");
  command->footer(
      "After 20 s one frame loses 15 % of its stiffness; the page says which, how much, how sure.\n"
      "Example: framewatch demo --seconds 60 --report demo.html");
  CLI::Option* report = command->add_option("--report", arguments.report,
                                            "page to write about it at the end (demo.html)");
  report->expected(0, 1)->type_name("[FILE]");
  command->add_option("--port", arguments.port, "of the live page; any free one if it is taken")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  command->add_option("--seconds", arguments.seconds, "how long the table shakes")
      ->check(CLI::Range(1, 3600))
      ->capture_default_str();
  command->add_flag("--quiet", arguments.quiet, "only whether the stiffnesses were found");
  command->callback([&action, &arguments, report] {
    if (report->count() > 0 && arguments.report.empty()) arguments.report = "demo.html";
    action = [&arguments] { return demo(arguments); };
  });
}

void add_run(CLI::App& app, Action& action, RunArguments& arguments) {
  CLI::App* command =
      app.add_subcommand("run", "the daemon: live samples in (LCM, CAN), estimates out (LCM)");
  command->footer(
      "SIGHUP reads CONFIG anew: what can change while it runs does, anything else is refused.\n"
      "Exit status: 0 stopped, 2 bad usage, configuration or input.\n"
      "Example: framewatch run configs/table_two_story.toml");
  command->add_option("CONFIG", arguments.config, "configuration file (TOML)")->required();
  command->add_option("--url", arguments.url, "LCM provider instead of the configuration's");
  command->add_option("--state", arguments.state,
                      "file that carries what was learned over a restart: read at the start,\n"
                      "written every --state-every seconds and at the end");
  command->add_option("--state-every", arguments.state_every_s, "seconds between two writes of it")
      ->check(CLI::Range(1, 86400))
      ->capture_default_str();
  command->add_option("--can-log", arguments.can_log,
                      "file for every frame of the CAN buses, as candump -l writes it");
  command->add_flag("--quiet", arguments.quiet, "only what goes wrong");
  command->callback([&action, &arguments] { action = [&arguments] { return run(arguments); }; });
}

void add_replay(CLI::App& app, Action& action, ReplayArguments& arguments) {
  CLI::App* command = app.add_subcommand(
      "replay", "the estimates of recorded motion, as fast as possible, the same bytes every time");
  command->footer(
      "Exit status: 0 done, and as expected; 1 not as --expect says; 2 bad usage, configuration,\n"
      "expectations or input.\n"
      "Examples:\n"
      "  framewatch replay building.toml monday.lcmlog tuesday.lcmlog.zst --out estimates.lcmlog\n"
      "  framewatch replay building.toml record.csv --json\n"
      "  framewatch replay building.toml golden.lcmlog --write-expect expected.toml\n"
      "  framewatch replay building.toml golden.lcmlog --expect expected.toml --junit result.xml");
  command->add_option("CONFIG", arguments.config, "configuration file (TOML)")->required();
  command
      ->add_option("LOG", arguments.inputs,
                   "LCM event logs, plain or .zst, and record files (CSV), in order of time")
      ->required();
  command->add_option("--out", arguments.out,
                      "file for the estimates: .lcmlog, .csv, .csv.gz or .mat (MATLAB 5)");
  command->add_flag("--boxplot", arguments.boxplot, "boxplot statistics in .csv and .mat too");
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
  command->add_option("--save-state", arguments.save_state,
                      "file to go on from with --load-state: the input goes on elsewhere");
  command->add_option("--load-state", arguments.load_state,
                      "go on where an earlier replay, or the daemon, stopped");
  command->add_option("--expect", arguments.expect, "file that says what must come out (TOML)");
  command->add_option("--write-expect", arguments.write_expect,
                      "make a first such file from what comes out");
  command->add_option("--write-baseline", arguments.write_baseline,
                      "baseline file for [watch] to write, of all windows of the replay");
  command->add_option("--junit", arguments.junit, "file for the result of --expect, as JUnit XML");
  command->add_flag("--salvage", arguments.salvage,
                    "replay what is intact of a damaged log instead of refusing it");
  command->add_flag("--quiet", arguments.quiet, "no progress, no summary");
  command->add_flag("--json", arguments.json, "the summary, and what is not as expected, as JSON");
  command->callback([&action, &arguments, lcm] {
    arguments.lcm = lcm->count() > 0;
    action = [&arguments] { return replay(arguments); };
  });
}

void add_diff(CLI::App& app, Action& action, DiffArguments& arguments) {
  CLI::App* command = app.add_subcommand(
      "diff", "two logs of estimates, field by field: the first and the worst difference of each");
  command->footer(
      "Exit status: 0 the estimates are the same, byte by byte; 1 they are not; 2 bad usage or "
      "input.\n"
      "Example: framewatch diff yesterday.lcmlog today.lcmlog");
  command->add_option("A", arguments.a, "LCM event log, plain or .zst")->required();
  command->add_option("B", arguments.b, "likewise")->required();
  command->add_flag("--json", arguments.json, "print what a program would read");
  command->add_flag("--quiet", arguments.quiet, "only the exit status");
  command->callback([&action, &arguments] { action = [&arguments] { return diff(arguments); }; });
}

void add_repair(CLI::App& app, Action& action, RepairArguments& arguments) {
  CLI::App* command =
      app.add_subcommand("repair", "every intact event of a damaged log, and what was lost where");
  command->footer(
      "Exit status: 0 nothing was damaged, or a whole log was written; 1 damaged, with --check; 2 "
      "bad\nusage or input. An intact log is left alone and no file is written.\n"
      "Examples:\n"
      "  framewatch repair night.lcmlog --out night.repaired.lcmlog\n"
      "  framewatch repair night.lcmlog --check --json");
  command->add_option("LOG", arguments.log, "LCM event log, plain or .zst")->required();
  command->add_option("--out", arguments.out,
                      "log to write (default: LOG with .repaired before its ending)");
  command->add_flag("--check", arguments.check, "write nothing, only say what is damaged");
  command->add_flag("--json", arguments.json, "print what a program would read");
  command->callback([&action, &arguments] { action = [&arguments] { return repair(arguments); }; });
}

void add_refine(CLI::App& app, Action& action, RefineArguments& arguments) {
  CLI::App* command = app.add_subcommand(
      "refine",
      "maximum-likelihood estimate from one stretch of recorded motion, and the least error\n"
      "(Cramer-Rao bound) that any estimate from it could have");
  command->footer(
      "Exit status: 0 refined, 1 not (too short, quiet, ...), 2 bad usage or input.\n"
      "Example: framewatch refine building.toml record.lcmlog --from 12 --to 22");
  command->add_option("CONFIG", arguments.config, "configuration file (TOML)")->required();
  command
      ->add_option("LOG", arguments.inputs,
                   "LCM event logs and record files (CSV), in order of time")
      ->required();
  command->add_option("--from", arguments.from_s, "seconds after the first sample")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--to", arguments.to_s, "likewise (default: one window after --from)")
      ->check(CLI::PositiveNumber);
  command->add_flag("!--no-prior", arguments.prior, "do not pull toward the design");
  command->add_flag("--json", arguments.json, "print what a program would read");
  command->callback([&action, &arguments] { action = [&arguments] { return refine(arguments); }; });
}

void add_check(CLI::App& app, Action& action, CheckArguments& arguments) {
  CLI::App* command = app.add_subcommand(
      "check", "every problem of a configuration at once, and what will be identifiable with it");
  command->footer("Example: framewatch check configs/table_two_story.toml");
  command->add_option("CONFIG", arguments.config, "configuration file (TOML)");
  command->add_flag("--json", arguments.json, "print what a program would read");
  command->add_flag("--print-options-markdown", arguments.print_options_markdown)->group("");
  command->add_flag("--print-effects-markdown", arguments.print_effects_markdown)->group("");
  command->callback([&action, &arguments] {
    if (arguments.config.empty() && !arguments.print_options_markdown &&
        !arguments.print_effects_markdown)
      throw CLI::RequiredError("CONFIG");
    action = [&arguments] { return check_command(arguments); };
  });
}

void add_convert(CLI::App& app, Action& action, ConvertArguments& arguments) {
  CLI::App* command = app.add_subcommand(
      "convert", "records to LCM event logs or CSV, logs of accelerations or estimates to CSV");
  command->footer(
      "What is read is told from the content, what is written from OUT's ending: .lcmlog, .csv or\n"
      ".csv.gz. Several records of one rate become one log. docs/formats.md has every format.\n"
      "Examples:\n"
      "  framewatch convert rec.csv --config table.toml rec.lcmlog\n"
      "  framewatch convert elcentro_NS.dat --unit g elcentro.csv\n"
      "  framewatch convert hachi.txt --unit gal --step 0.01 hachi.lcmlog\n"
      "  framewatch convert ground.csv.gz first.csv.gz second.csv.gz top.csv.gz run.lcmlog\n"
      "  framewatch convert est.lcmlog --boxplot est.csv");
  command
      ->add_option("FILES", arguments.inputs,
                   "IN... OUT: record files or one event log, then the output")
      ->required()
      ->expected(2, 1000)
      ->type_name("");
  command->add_option("--unit", arguments.unit, "of a file that does not say it: g, gal, mps2");
  command->add_option("--step", arguments.step_s, "seconds between samples of a file without time");
  command->add_option("--format", arguments.format, "csv, at2, two-columns, rows or xsens")
      ->capture_default_str();
  command->add_option("--config", arguments.config,
                      "configuration whose channels say where the columns of their names travel");
  command->add_option("--channel", arguments.channel,
                      "LCM channel to write (default ACCEL) or to read");
  command->add_flag("--boxplot", arguments.boxplot, "boxplot columns beside the estimates");
  command->add_flag("--denoise", arguments.denoise,
                    "the paper's removal of noise on every channel of a record, for comparison");
  command->add_option("--start-us", arguments.start_us, "sensor time of a record's time zero");
  command->callback([&action, &arguments] {
    arguments.out = arguments.inputs.back();
    arguments.inputs.pop_back();
    action = [&arguments] { return convert(arguments); };
  });
}

void add_simulate(CLI::App& app, Action& action, SimulateArguments& arguments) {
  CLI::App* command = app.add_subcommand(
      "simulate", "a virtual building's accelerometers, to LCM, to CAN or to a file");
  command->footer(
      "Examples:\n"
      "  framewatch simulate configs/scenario_table_two_story.toml --out rec.lcmlog\n"
      "  framewatch simulate configs/scenario_paper_table1.toml --lcm --speed 2\n"
      "  framewatch simulate configs/can/scenario_tower.toml --can vcan0");
  command->add_option("SCENARIO", arguments.scenario, "scenario file (TOML)")->required();
  command->add_option("--out", arguments.out, "file to write: .csv, .csv.gz or .lcmlog");
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
  command->add_option("--truth", arguments.truth, "JSON file to write what is hidden to");
  command->add_flag("--quiet", arguments.quiet, "no progress, no summary");
  command->callback([&action, &arguments, lcm, can] {
    arguments.lcm = lcm->count() > 0;
    arguments.can = can->count() > 0;
    action = [&arguments] { return simulate(arguments); };
  });
}

void add_reproduce(CLI::App& app, Action& action, ReproduceArguments& arguments) {
  CLI::App* command = app.add_subcommand(
      "reproduce",
      "the paper's examples again: its tables and figures, its method against this one");
  command->footer(
      "Writes DIR/report.html and, with all cases, DIR/accuracy.md. The paper's ground motions and "
      "the\nmeasured shaking table are looked for in the folder FRAMEWATCH_DATA; seeded motions "
      "stand in.\n"
      "Cases: table1, table2b, table2c, table2d, noise, denoise, table-test.\n"
      "Exit status: 0 written and every promise kept, 1 one not kept, 2 bad usage.\n"
      "Example: framewatch reproduce --case table1 --out /tmp/paper");
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
  command->callback(
      [&action, &arguments] { action = [&arguments] { return reproduce(arguments); }; });
}

void add_diagnose(CLI::App& app, Action& action, DiagnoseArguments& arguments) {
  CLI::App* command = app.add_subcommand(
      "diagnose",
      "where simulation and measurement disagree, the missing effect's name, the augmented model");
  command->footer(
      "Writes diagnosis.json, report.html and model.toml. Exit status: 0 adequate or explained, 1 "
      "a\n"
      "gap remains, 2 bad usage, configuration or input.\n"
      "Examples:\n"
      "  framewatch diagnose building.toml --train monday.csv --holdout tuesday.csv --out d\n"
      "  framewatch diagnose building.toml --event 1795291200000000 --out d");
  command->add_option("CONFIG", arguments.config, "configuration file (TOML)")->required();
  command->add_option("--train", arguments.train, "record files and LCM event logs");
  command->add_option("--holdout", arguments.holdout, "records of other motions, to judge by");
  command->add_option("--event", arguments.event,
                      "id of a gap event: the samples stored of it, first half and second half, "
                      "instead of --train and --holdout");
  command->add_option("--out", arguments.out, "directory to write to")->required();
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
  command->callback(
      [&action, &arguments] { action = [&arguments] { return diagnose_command(arguments); }; });
}

void add_adopt(CLI::App& app, Action& action, AdoptArguments& arguments) {
  CLI::App* command = app.add_subcommand(
      "adopt", "puts a model where the gap monitor of a running daemon takes it");
  command->footer("Example: framewatch adopt building.toml d/model.toml");
  command->add_option("CONFIG", arguments.config, "configuration file (TOML) with [gap] model")
      ->required();
  command->add_option("MODEL", arguments.model, "model.toml of framewatch diagnose")->required();
  command->add_flag("--quiet", arguments.quiet, "do not say what it has");
  command->callback([&action, &arguments] { action = [&arguments] { return adopt(arguments); }; });
}

void add_report(CLI::App& app, Action& action, ReportArguments& arguments) {
  CLI::App* command = app.add_subcommand(
      "report", "one self-contained page of a session: boxplots, parameters, histories, loops");
  command->footer(
      "With --config and --raw also stages (forced and free vibration side by side),\n"
      "reference-dynamic values, transfer functions, drifts and forces.\n"
      "Example: framewatch report est.lcmlog --config table.toml --raw raw.lcmlog --out r.html");
  command->add_option("EST", arguments.estimates, "LCM event log of estimates")->required();
  command->add_option("--out", arguments.out, "page to write (default: EST with .html)");
  command->add_option("--config", arguments.config, "the building's configuration (TOML)");
  command->add_option("--raw", arguments.raw,
                      "raw samples: LCM event logs and record files, in order of time");
  command->add_option("--title", arguments.title, "of the page");
  command->add_option("--test", arguments.test, "name of the test");
  command->add_option("--operator", arguments.operator_name, "who made it");
  command->add_option("--notes", arguments.notes, "what the next reader should know");
  command->add_option("--session", arguments.session,
                      "session.json of framewatch record: check of the channels, trigger");
  command->add_flag("--quiet", arguments.quiet, "do not print the page's path");
  command->callback([&action, &arguments] { action = [&arguments] { return report(arguments); }; });
}

void add_record(CLI::App& app, Action& action, RecordArguments& arguments) {
  CLI::App* command = app.add_subcommand(
      "record", "acquisition sessions: raw samples and estimates in logs, and a report at the end");
  command->footer(
      "Checks the channels for 3 s, then records until Ctrl-C, --seconds or --send stop. With\n"
      "--standby it waits for the live page, or for --send from another terminal.\n"
      "Exit status: 0 recorded and reported, 1 not everything, 2 bad usage or configuration.\n"
      "Examples:\n"
      "  framewatch record table.toml --test \"El Centro 30 %\" --operator me --seconds 60\n"
      "  framewatch record table.toml --test sweep --trigger 0.2 --pre-trigger 5 --seconds 60\n"
      "  framewatch record table.toml --standby --out /data/sessions\n"
      "  framewatch record table.toml --send start --test sweep");
  command->add_option("CONFIG", arguments.config, "configuration file (TOML)")->required();
  command->add_option("--url", arguments.url, "LCM provider instead of the configuration's");
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
  command->add_flag("!--no-check", arguments.check, "begin without the check of the channels");
  command->add_flag("--strict", arguments.strict, "record nothing when a channel has a problem");
  command->add_flag("--standby", arguments.standby, "wait for commands, session after session");
  command
      ->add_option("--send", arguments.send, "tell the recorder that runs: start, arm, tap or stop")
      ->check(CLI::IsMember({"start", "arm", "tap", "stop"}));
  command->add_option("--finish", arguments.finish,
                      "stages and report of a session that was cut off, or whose report failed");
  command->add_option("--reports", arguments.reports,
                      "folder for the report (default: the session's own)");
  command->add_flag("--csv", arguments.csv, "raw samples and estimates as CSV too");
  command->add_flag("--mat", arguments.mat, "raw samples and estimates for MATLAB too");
  command->add_flag("--split", arguments.split, "a raw log for every stage too");
  command->add_flag("!--no-report", arguments.report, "no report at the end");
  command->add_flag("--quiet", arguments.quiet, "only what goes wrong");
  command->callback([&action, &arguments, before] {
    if (before->count() == 0 && arguments.request.trigger_mps2 > 0)
      arguments.request.pre_trigger_s = 5;
    action = [&arguments] { return record(arguments); };
  });
}

void add_serve(CLI::App& app, Action& action, ServeArguments& arguments) {
  CLI::App* command = app.add_subcommand(
      "serve", "the live page: building, boxplots, histories, health and alarms in a browser");
  command->footer(
      "Prints the page's address. Whoever opens it with its token may acknowledge alarms. An\n"
      "address that others can reach needs a token of your own, in a file.\n"
      "Examples:\n"
      "  framewatch serve configs/table_two_story.toml\n"
      "  framewatch serve b.toml --address 192.168.1.7 --token-file /etc/framewatch/token");
  command->add_option("CONFIG", arguments.config, "configuration file (TOML)")->required();
  command->add_option("--url", arguments.url, "LCM provider instead of the configuration's");
  command->add_option("--address", arguments.address, "IP address to listen on")
      ->capture_default_str();
  command->add_option("--port", arguments.port, "to listen on; 0: any free one")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  command->add_option("--token-file", arguments.token_file,
                      "file with the token, 16 letters, digits, - or _ at least");
  command->add_option("--host", arguments.hosts, "further host name the page may be opened under");
  command
      ->add_option("--sessions", arguments.sessions,
                   "folder of framewatch record (--out), whose reports the page opens")
      ->type_name("DIR")
      ->capture_default_str();
  command->add_option("--page", arguments.files, "folder to read the page from, for work on it");
  command->add_flag("--quiet", arguments.quiet, "only the address and what goes wrong");
  command->callback([&action, &arguments] { action = [&arguments] { return serve(arguments); }; });
}

void add_history(CLI::App& app, Action& action, HistoryArguments& arguments) {
  CLI::App* command = app.add_subcommand(
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
  command->add_option("--out", arguments.out,
                      "file for the summaries: .csv, .csv.gz or .mat (MATLAB 5)");
  command->add_option("--raw", arguments.raw,
                      "file for raw samples: .lcmlog, .csv, .csv.gz or .mseed (miniSEED)");
  command->add_option("--channel", arguments.channels, "of the raw samples (default: all)");
  command->add_option("--network", arguments.network, "SEED network code")->capture_default_str();
  command->add_option("--station", arguments.station, "SEED station code")->capture_default_str();
  command->add_flag("--events", arguments.events, "every event instead of summaries");
  command->add_flag("--json", arguments.json, "the overview as a program would read it");
  command->callback(
      [&action, &arguments] { action = [&arguments] { return history(arguments); }; });
}

void add_status(CLI::App& app, Action& action, StatusArguments& arguments) {
  CLI::App* command = app.add_subcommand(
      "status", "whether the running daemon is well, since when, and what is odd, on one screen");
  command->footer(
      "Listens to the daemon's messages for 2 to 4 s.\n"
      "Exit status: 0 well, 1 not well, 2 nothing is heard of it, or bad usage or configuration.\n"
      "Example: framewatch status building.toml");
  command->add_option("CONFIG", arguments.config, "configuration file (TOML)")
      ->capture_default_str();
  command->add_option("--url", arguments.url, "LCM provider instead of the configuration's");
  command->add_flag("--json", arguments.json, "print what a program would read");
  command->callback(
      [&action, &arguments] { action = [&arguments] { return status_command(arguments); }; });
}

void add_acknowledge(CLI::App& app, Action& action, AcknowledgeArguments& arguments) {
  CLI::App* command =
      app.add_subcommand("acknowledge", "tell the running daemon that somebody knows of an event");
  command->footer(
      "`framewatch status` says the numbers of the events that are raised. An acknowledged event "
      "is\n"
      "not odd any more, and [actions] tell nobody of it until it is cleared.\n"
      "Exit status: 0 acknowledged, 1 no such event is raised, 2 no answer, or bad usage or\n"
      "configuration.\n"
      "Example: framewatch acknowledge 3 --comment 'a loose sensor, fixed tomorrow'");
  command->add_option("EVENT", arguments.event, "number of the event, or all")->required();
  command->add_option("CONFIG", arguments.config, "configuration file (TOML)")
      ->capture_default_str();
  command->add_option("--comment", arguments.comment, "what is known of it");
  command->add_option("--who", arguments.who, "who knows (default: the user's name)");
  command->add_option("--url", arguments.url, "LCM provider instead of the configuration's");
  command->callback(
      [&action, &arguments] { action = [&arguments] { return acknowledge_command(arguments); }; });
}

void add_tell(CLI::App& app, Action& action, TellArguments& arguments) {
  CLI::App* command = app.add_subcommand(
      "tell", "try the command and the webhook of [actions], with an event of kind \"test\"");
  command->footer(
      "Exit status: 0 somebody was told, 1 one of them failed, 2 bad usage or configuration.\n"
      "Example: framewatch tell building.toml");
  command->add_option("CONFIG", arguments.config, "configuration file (TOML)")
      ->capture_default_str();
  command->add_option("--message", arguments.message, "what the event says")->capture_default_str();
  command->callback(
      [&action, &arguments] { action = [&arguments] { return tell_command(arguments); }; });
}

void add_selftest(CLI::App& app, Action& action, SelftestArguments& arguments) {
  CLI::App* command = app.add_subcommand(
      "selftest",
      "whether this machine can carry the daemon: network, buffers, clock, disk, and\n"
      "an estimate whose answer is known");
  command->footer(
      "Exit status: 0 all good, 1 not all, 2 bad usage or configuration.\n"
      "Example: framewatch selftest building.toml --dir /var/lib/framewatch");
  command->add_option("CONFIG", arguments.config,
                      "configuration file (TOML), for its LCM settings");
  command->add_option("--dir", arguments.directory, "where state and records go")
      ->type_name("DIR")
      ->capture_default_str();
  command->add_flag("--json", arguments.json, "print what a program would read");
  command->callback(
      [&action, &arguments] { action = [&arguments] { return selftest(arguments); }; });
}

/// What every command can be told, as far as the command line tells it.
struct Arguments {
  DemoArguments demo;
  RunArguments run;
  ReplayArguments replay;
  DiffArguments diff;
  RepairArguments repair;
  RefineArguments refine;
  DiagnoseArguments diagnose;
  AdoptArguments adopt;
  CheckArguments check;
  ConvertArguments convert;
  SimulateArguments simulate;
  ReproduceArguments reproduce;
  ReportArguments report;
  ServeArguments serve;
  RecordArguments record;
  HistoryArguments history;
  StatusArguments status;
  TellArguments tell;
  AcknowledgeArguments acknowledge;
  SelftestArguments selftest;
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "framewatch: stiffness and damping of every frame and floor panel of a building,\n"
      "from its accelerometers, while it moves."};
  app.name("framewatch");
  app.require_subcommand(1);
  app.set_version_flag("--version", FRAMEWATCH_VERSION);
  Action action;
  Arguments arguments;

  add_demo(app, action, arguments.demo);
  add_run(app, action, arguments.run);
  add_replay(app, action, arguments.replay);
  add_diff(app, action, arguments.diff);
  add_repair(app, action, arguments.repair);
  add_refine(app, action, arguments.refine);
  add_diagnose(app, action, arguments.diagnose);
  add_adopt(app, action, arguments.adopt);
  add_check(app, action, arguments.check);
  add_convert(app, action, arguments.convert);
  add_simulate(app, action, arguments.simulate);
  add_reproduce(app, action, arguments.reproduce);
  add_report(app, action, arguments.report);
  add_serve(app, action, arguments.serve);
  add_record(app, action, arguments.record);
  add_history(app, action, arguments.history);
  add_status(app, action, arguments.status);
  add_acknowledge(app, action, arguments.acknowledge);
  add_tell(app, action, arguments.tell);
  add_selftest(app, action, arguments.selftest);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return action ? action() : 2;
}
