// SPDX-License-Identifier: MIT
#include <CLI/CLI.hpp>

#include "daemon/command_line/command_list.h"
#include "daemon/monitor/actions/acknowledge.h"
#include "daemon/monitor/actions/note.h"
#include "daemon/monitor/actions/tell_command.h"
#include "daemon/monitor/live/run_command.h"
#include "daemon/page/findings/status_command.h"
#include "daemon/page/web/serve_command.h"
#include "daemon/tools/commands/selftest_command.h"
#include "daemon/tools/demo/demo_command.h"

namespace framewatch::daemon {

void add_demo(CommandList& commands) {
  DemoArguments& arguments = commands.arguments<DemoArguments>();
  CLI::App* command = commands.add(
      "demo",
      "run a virtual shaking-table test over LCM with a live page, and compare with the truth",
      "After 20 s one frame loses 15 % of its stiffness. The page shows which one, how much "
      "and\nwith what error. With 20 stories, five lose 20 % in one frame; groups of stories are "
      "identified.\nExamples:\n  framewatch demo --seconds 40 --report demo.html\n  framewatch "
      "demo --building 20 --seconds 40");
  command
      ->add_option(
          "--building", arguments.building,
          "stories: 2 (a channel on every frame of every floor) or 20 (channels on five levels)")
      ->check(CLI::IsMember({2, 20}))
      ->capture_default_str();
  command
      ->add_option("--can", arguments.can,
                   "send the samples as CAN frames on this interface, without a page")
      ->type_name("INTERFACE");
  CLI::Option* report = command->add_option("--report", arguments.report,
                                            "report to write at the end (default: demo.html)");
  report->expected(0, 1)->type_name("[FILE]");
  command
      ->add_option("--port", arguments.port, "port of the live page; if it is taken, any free one")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  command->add_option("--seconds", arguments.seconds, "duration of the shaking")
      ->check(CLI::Range(1, 3600))
      ->capture_default_str();
  command->add_flag("--quiet", arguments.quiet, "print only if the stiffnesses were found");
  commands.set_action(command, [&arguments, report] {
    if (report->count() > 0 && arguments.report.empty()) arguments.report = "demo.html";
    return demo(arguments);
  });
}

void add_run(CommandList& commands) {
  RunArguments& arguments = commands.arguments<RunArguments>();
  CLI::App* command = commands.add(
      "run", "run the daemon: read live samples (LCM, CAN), publish estimates (LCM)",
      "SIGHUP reloads CONFIG. Changes that need a restart are refused.\nExit status: 0 stopped, 1 "
      "the disk did not take what was left, 2 bad usage, configuration or input.\nExample: "
      "framewatch run configs/table_two_story.toml");
  add_config(commands, command, arguments.config);
  add_url(command, arguments.url);
  add_file(command, "--state", arguments.state,
           "file that keeps the learned state over a restart: read at the start,\nwritten "
           "every --state-every seconds and at the end");
  command->add_option("--state-every", arguments.state_every_s, "seconds between state saves")
      ->check(CLI::Range(1, 86400))
      ->capture_default_str();
  // A container gets 10 s to stop.
  command
      ->add_option(
          "--stop-within", arguments.stop_within_s,
          "seconds after a stop signal in which the disk must take what is left; then\nrun "
          "ends with status 1")
      ->envname("FRAMEWATCH_STOP_WITHIN")
      ->check(CLI::Range(1, 3600))
      ->capture_default_str();
  add_file(command, "--can-log", arguments.can_log,
           "log every frame of the CAN buses to this file, in the format of candump -l");
  command->add_flag(
      "--by-name", arguments.by_name,
      "match channels without a source by the names that nodes send (channel_table_t)");
  command->add_flag("--quiet", arguments.quiet, "print only errors and warnings");
  commands.set_action(command, [&arguments] { return run(arguments); });
}

void add_serve(CommandList& commands) {
  ServeArguments& arguments = commands.arguments<ServeArguments>();
  CLI::App* command = commands.add(
      "serve", "serve the live page: building, boxplots, histories, health and alarms in a browser",
      "Prints the page's address. Everyone who has the token in it can acknowledge alarms.\nAn "
      "address that other machines can reach needs --token-file.\nExamples:\n  framewatch serve "
      "configs/table_two_story.toml\n  framewatch serve b.toml --address 192.168.1.7 --token-file "
      "token");
  add_config(commands, command, arguments.config);
  add_url(command, arguments.url);
  command->add_option("--address", arguments.address, "IP address to listen on")
      ->capture_default_str();
  command->add_option("--port", arguments.port, "port to listen on; 0: any free one")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  add_file(command, "--token-file", arguments.token_file,
           "file with the token: at least 16 letters, digits, - or _");
  command->add_option("--host", arguments.hosts,
                      "further host name under which the page may be opened");
  add_folder(command, "--sessions", arguments.sessions,
             "show the reports in this folder of `framewatch record` (its --out)")
      ->capture_default_str();
  command->add_option("--viewers", arguments.viewers, "largest number of open pages")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  command
      ->add_option("--viewers-per-address", arguments.viewers_per_address,
                   "largest number of open pages per address; behind a proxy all pages share one")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  add_folder(command, "--page", arguments.files, "read the page from this folder, for development");
  command->add_flag("--quiet", arguments.quiet, "print only the address, errors and warnings");
  commands.set_action(command, [&arguments] { return serve(arguments); });
}

void add_status(CommandList& commands) {
  StatusArguments& arguments = commands.arguments<StatusArguments>();
  CLI::App* command = commands.add(
      "status", "show on one screen if the running daemon is well, since when, and what is wrong",
      "Listens to the daemon's messages for 2 to 4 s.\nExit status: 0 well, 1 not well, 2 no "
      "message from it, or bad usage or configuration.\nExample: framewatch status building.toml");
  add_installed_config(command, arguments.config);
  add_url(command, arguments.url);
  add_json(command, arguments.json);
  commands.set_action(command, [&arguments] { return status_command(arguments); });
}

void add_acknowledge(CommandList& commands) {
  AcknowledgeArguments& arguments = commands.arguments<AcknowledgeArguments>();
  CLI::App* command = commands.add(
      "acknowledge", "acknowledge an event of the running daemon",
      "`framewatch status` shows the numbers of raised events. An acknowledged event no "
      "longer\nmakes the status bad, and [actions] send no notifications about it until it is "
      "cleared.\nExit status: 0 acknowledged, 1 no such event is raised, 2 no answer, or bad usage "
      "or\nconfiguration. Only the daemon's user and the group of its socket may acknowledge "
      "events.\nExample: framewatch acknowledge 3 building.toml --comment \"a loose sensor, fixed "
      "tomorrow\"");
  command->add_option("EVENT", arguments.event, "number of the event, or all")->required();
  add_installed_config(command, arguments.config);
  command->add_option("--comment", arguments.comment, "comment stored with the acknowledgement");
  command->add_option("--who", arguments.who, "name to store in addition to the user's name");
  commands.set_action(command, [&arguments] { return acknowledge_command(arguments); });
}

void add_note(CommandList& commands) {
  NoteArguments& arguments = commands.arguments<NoteArguments>();
  CLI::App* command = commands.add(
      "note", "keep a note about the building in the history of the running daemon",
      "Pages, reports and `framewatch history --events` show it. With --maintenance, the search "
      "for\nlasting losses begins anew on that day, so that work on the building is not taken for "
      "damage.\nExit status: 0 kept, 1 refused, 2 no answer, or bad usage or configuration. Only "
      "the daemon's\nuser and the group of its socket may write notes.\nExample: framewatch note "
      "\"bookshelves on floor 3\" building.toml --maintenance --at 2026-11-27");
  command->add_option("TEXT", arguments.text, "what happened")->required();
  add_installed_config(command, arguments.config);
  command->add_flag("--maintenance", arguments.maintenance,
                    "the building was changed on purpose: its mass, stiffness or damping");
  command->add_option("--at", arguments.at, "when, UTC (default: now)")->type_name("TIME");
  command->add_option("--who", arguments.who, "name to store in addition to the user's name");
  commands.set_action(command, [&arguments] { return note_command(arguments); });
}

void add_tell(CommandList& commands) {
  TellArguments& arguments = commands.arguments<TellArguments>();
  CLI::App* command =
      commands.add("tell", "try each receiver of [actions] with an event of kind \"test\"",
                   "Prints what each answered.\n"
                   "Exit status: 0 delivered, 1 a receiver failed, 2 bad usage or "
                   "configuration.\nExample: framewatch tell building.toml");
  add_installed_config(command, arguments.config);
  command->add_option("--message", arguments.message, "message of the event")
      ->capture_default_str();
  commands.set_action(command, [&arguments] { return tell_command(arguments); });
}

void add_selftest(CommandList& commands) {
  SelftestArguments& arguments = commands.arguments<SelftestArguments>();
  CLI::App* command =
      commands.add("selftest",
                   "check this machine for the daemon: network, buffers, clock, "
                   "disk, and an\nestimate with a known result",
                   "Exit status: 0 all good, 1 not all, 2 bad usage or configuration.\n"
                   "Example: framewatch selftest building.toml --dir /var/lib/framewatch");
  command->add_option("CONFIG", arguments.config,
                      "configuration file (TOML) with the LCM settings");
  add_folder(command, "--dir", arguments.directory, "folder for state and records")
      ->capture_default_str();
  add_json(command, arguments.json);
  commands.set_action(command, [&arguments] { return selftest(arguments); });
}

}  // namespace framewatch::daemon
