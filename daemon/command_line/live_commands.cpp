#include <CLI/CLI.hpp>

#include "daemon/command_line/command_list.h"
#include "daemon/monitor/actions/acknowledge.h"
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
      "a virtual two-story shaking-table test over LCM, with a live page and a table of truth");
  command
      ->add_option("--building", arguments.building,
                   "stories: 2, a channel on every frame of every floor, or 20, on five levels")
      ->check(CLI::IsMember({2, 20}))
      ->capture_default_str();
  command
      ->add_option("--can", arguments.can,
                   "interface that carries the samples, as frames; no page then")
      ->type_name("INTERFACE");
  command->footer(
      "After 20 s one frame loses 15 % of its stiffness; the page says which, how much, how sure.\n"
      "Of 20 stories, five lose 20 % in one frame: groups of stories are what is told apart "
      "there.\n"
      "Examples:\n"
      "  framewatch demo --seconds 40 --report demo.html\n"
      "  framewatch demo --building 20 --seconds 40");
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
  commands.set_action(command, [&arguments, report] {
    if (report->count() > 0 && arguments.report.empty()) arguments.report = "demo.html";
    return demo(arguments);
  });
}

void add_run(CommandList& commands) {
  RunArguments& arguments = commands.arguments<RunArguments>();
  CLI::App* command =
      commands.add("run", "the daemon: live samples in (LCM, CAN), estimates out (LCM)");
  command->footer(
      "SIGHUP reads CONFIG anew: what can change while it runs does, anything else is refused.\n"
      "Exit status: 0 stopped, 2 bad usage, configuration or input.\n"
      "Example: framewatch run configs/table_two_story.toml");
  add_config(commands, command, arguments.config);
  add_url(command, arguments.url);
  command
      ->add_option("--state", arguments.state,
                   "file that carries what was learned over a restart: read at the start,\n"
                   "written every --state-every seconds and at the end")
      ->type_name("FILE");
  command->add_option("--state-every", arguments.state_every_s, "seconds between two writes of it")
      ->check(CLI::Range(1, 86400))
      ->capture_default_str();
  command
      ->add_option("--can-log", arguments.can_log,
                   "file for every frame of the CAN buses, as candump -l writes it")
      ->type_name("FILE");
  command->add_flag("--by-name", arguments.by_name,
                    "channels without a source are those that nodes name (channel_table_t)");
  command->add_flag("--quiet", arguments.quiet, "only what goes wrong");
  commands.set_action(command, [&arguments] { return run(arguments); });
}

void add_serve(CommandList& commands) {
  ServeArguments& arguments = commands.arguments<ServeArguments>();
  CLI::App* command = commands.add(
      "serve", "the live page: building, boxplots, histories, health and alarms in a browser");
  command->footer(
      "Prints the page's address. Whoever opens it with its token may acknowledge alarms. An\n"
      "address that others can reach needs a token of your own, in a file.\n"
      "Examples:\n"
      "  framewatch serve configs/table_two_story.toml\n"
      "  framewatch serve b.toml --address 192.168.1.7 --token-file token");
  add_config(commands, command, arguments.config);
  add_url(command, arguments.url);
  command->add_option("--address", arguments.address, "IP address to listen on")
      ->capture_default_str();
  command->add_option("--port", arguments.port, "to listen on; 0: any free one")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  command
      ->add_option("--token-file", arguments.token_file,
                   "file with the token, 16 letters, digits, - or _ at least")
      ->type_name("FILE");
  command->add_option("--host", arguments.hosts, "further host name the page may be opened under");
  command
      ->add_option("--sessions", arguments.sessions,
                   "folder of framewatch record (--out), whose reports the page opens")
      ->type_name("DIR")
      ->capture_default_str();
  command->add_option("--viewers", arguments.viewers, "pages open at once, at most")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  command
      ->add_option("--viewers-per-address", arguments.viewers_per_address,
                   "of them from one address, at most; behind a proxy all come from one")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  command->add_option("--page", arguments.files, "folder to read the page from, for work on it")
      ->type_name("DIR");
  command->add_flag("--quiet", arguments.quiet, "only the address and what goes wrong");
  commands.set_action(command, [&arguments] { return serve(arguments); });
}

void add_status(CommandList& commands) {
  StatusArguments& arguments = commands.arguments<StatusArguments>();
  CLI::App* command = commands.add(
      "status", "whether the running daemon is well, since when, and what is odd, on one screen");
  command->footer(
      "Listens to the daemon's messages for 2 to 4 s.\n"
      "Exit status: 0 well, 1 not well, 2 nothing is heard of it, or bad usage or configuration.\n"
      "Example: framewatch status building.toml");
  add_installed_config(command, arguments.config);
  add_url(command, arguments.url);
  add_json(command, arguments.json);
  commands.set_action(command, [&arguments] { return status_command(arguments); });
}

void add_acknowledge(CommandList& commands) {
  AcknowledgeArguments& arguments = commands.arguments<AcknowledgeArguments>();
  CLI::App* command =
      commands.add("acknowledge", "tell the running daemon that somebody knows of an event");
  command->footer(
      "`framewatch status` says the numbers of the events that are raised. An acknowledged event "
      "is\n"
      "not odd any more, and [actions] tell nobody of it until it is cleared.\n"
      "Exit status: 0 acknowledged, 1 no such event is raised, 2 no answer, or bad usage or\n"
      "configuration. It takes the right to tell the daemon: its user, or the group of its "
      "socket.\n"
      "Example: framewatch acknowledge 3 building.toml --comment \"a loose sensor, fixed "
      "tomorrow\"");
  command->add_option("EVENT", arguments.event, "number of the event, or all")->required();
  add_installed_config(command, arguments.config);
  command->add_option("--comment", arguments.comment, "what is known of it");
  command->add_option("--who", arguments.who,
                      "a remark on who knows; the user's name is there in any case");
  commands.set_action(command, [&arguments] { return acknowledge_command(arguments); });
}

void add_tell(CommandList& commands) {
  TellArguments& arguments = commands.arguments<TellArguments>();
  CLI::App* command = commands.add(
      "tell", "try the command and the webhook of [actions], with an event of kind \"test\"");
  command->footer(
      "Exit status: 0 somebody was told, 1 one of them failed, 2 bad usage or configuration.\n"
      "Example: framewatch tell building.toml");
  add_installed_config(command, arguments.config);
  command->add_option("--message", arguments.message, "what the event says")->capture_default_str();
  commands.set_action(command, [&arguments] { return tell_command(arguments); });
}

void add_selftest(CommandList& commands) {
  SelftestArguments& arguments = commands.arguments<SelftestArguments>();
  CLI::App* command =
      commands.add("selftest",
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
  add_json(command, arguments.json);
  commands.set_action(command, [&arguments] { return selftest(arguments); });
}

}  // namespace framewatch::daemon
