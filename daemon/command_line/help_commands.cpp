#include <algorithm>
#include <cstdio>
#include <string>

#include <CLI/CLI.hpp>

#include "daemon/base/exit_code.h"
#include "daemon/command_line/command_list.h"
#include "daemon/command_line/option_entries.h"

namespace framewatch::daemon {
namespace {

struct HelpArguments {
  std::string command;
  bool man = false;
};

/// What it does not take is found at the end of the program: fmt::print() would throw.
void print(const std::string& text) {
  (void)std::fputs(text.c_str(), stdout);
}

int help(const CLI::App& app, const HelpArguments& a) {
  const std::vector<CommandEntry> commands = command_entries(app);
  if (a.command.empty()) {
    print(a.man ? program_man_page(commands)
                : app.get_formatter()->make_help(&app, app.get_name(), CLI::AppFormatMode::Normal));
    return 0;
  }
  if (const std::string why = no_such_command(app.get_name(), commands, a.command); !why.empty())
    return refuse("help", why);
  const auto entry = std::find_if(commands.begin(), commands.end(),
                                  [&](const CommandEntry& c) { return c.name == a.command; });
  print(a.man ? command_man_page(app.get_name(), *entry)
              : app.get_subcommand(a.command)->help(app.get_name()));
  return 0;
}

}  // namespace

void add_help(CommandList& commands) {
  HelpArguments& arguments = commands.arguments<HelpArguments>();
  CLI::App* command = commands.add("help", "how the program, or one of its commands, is used");
  command->footer(commands.program() == "framewatch" ? "Examples:\n"
                                                       "  framewatch help replay\n"
                                                       "  framewatch help replay --man | man -l -"
                                                     : "");
  command->add_option("COMMAND", arguments.command, "the command; none: the list of commands");
  command->add_flag("--man", arguments.man, "as a manual page, in the language of man(7)");
  commands.set_action(command,
                      [&arguments, command] { return help(*command->get_parent(), arguments); });
}

void add_completion(CommandList& commands) {
  std::string& shell = commands.arguments<std::string>();
  CLI::App* command = commands.add(
      "completion", "a script by which a shell completes commands, options and their values");
  command->footer(
      "The Debian package has them in place already.\n"
      "Examples:\n"
      "  source <(framewatch completion bash)\n"
      "  framewatch completion fish > ~/.config/fish/completions/framewatch.fish");
  command->add_option("SHELL", shell, "bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  commands.set_action(command, [&shell, command] {
    print(completion_script(shell, command_entries(*command->get_parent())));
    return 0;
  });
}

}  // namespace framewatch::daemon
