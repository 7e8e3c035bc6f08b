// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "daemon/base/exit_code.h"
#include "daemon/command_line/command_list.h"
#include "daemon/command_line/option_entries.h"

namespace framewatch::daemon {
namespace {

/// Escapes text for man(7): dashes that can be copied, and no line that looks like a request.
std::string roff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n'))
      out += std::string("\\&") + c;
    else
      out += c;
  }
  return out;
}

std::string heading(const std::string& name) {
  std::string capitals;
  for (const char c : name)
    capitals += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return fmt::format(".TH {} 1 \"\" \"framewatch {}\" \"User Commands\"\n", roff(capitals),
                     FRAMEWATCH_VERSION);
}

std::string synopsis(const std::string& program, const CommandEntry& command) {
  std::string out = fmt::format(".B {} {}\n.RI [ OPTION ...]\n", program, command.name);
  for (const OptionEntry& option : command.options) {
    if (!option.is_argument) continue;
    const std::string more = option.takes_many ? " ..." : "";
    out += option.is_required ? fmt::format(".IR {}{}\n", roff(option.name), more)
                              : fmt::format(".RI [ {}{} ]\n", roff(option.name), more);
  }
  return out;
}

std::string option_item(const OptionEntry& option) {
  std::string head = option.is_argument ? fmt::format(".I {}", roff(option.name))
                                        : fmt::format(".BI \"{}", roff(option.name));
  if (!option.is_argument) {
    if (!option.value.empty())
      head += option.value_may_lack ? fmt::format(" [\" {} ]", roff(option.value))
                                    : fmt::format(" \" {}", roff(option.value));
    else
      head += '"';
  }
  std::string out = ".TP\n" + head + "\n" + roff(option.text) + "\n";
  if (!option.choices.empty() && !option.is_argument)
    out += fmt::format("({})\n", roff(fmt::format("{}", fmt::join(option.choices, ", "))));
  return out;
}

/// Formats the text before "Example" and keeps the rest unchanged.
std::string footer_sections(const std::string& footer) {
  std::istringstream lines(footer);
  std::string line, text, examples;
  bool in_examples = false;
  while (std::getline(lines, line)) {
    if (line.starts_with("Example")) {
      in_examples = true;
      const std::size_t colon = line.find(": ");
      line = colon == std::string::npos ? "" : line.substr(colon + 2);
      if (line.empty()) continue;
    }
    if (in_examples)
      examples += roff(line.substr(line.find_first_not_of(' '))) + "\n";
    else
      text += roff(line) + "\n";
  }
  std::string out = text.empty() ? "" : ".SH NOTES\n" + text;
  if (!examples.empty()) out += ".SH EXAMPLES\n.nf\n" + examples + ".fi\n";
  return out;
}

constexpr const char* kStreams =
    ".SH STANDARD STREAMS\nThe file name\n.B \\-\nis standard input for reading, for one file of a "
    "command, and standard output for writing.\nStandard output then has CSV (for a report: HTML) "
    "and no summary. A file with this name is\n.BR ./\\- .\n";

constexpr const char* kRest =
    ".SH EXIT STATUS\n"
    "0: done and good. 1: done and not good. 2: bad usage, configuration or input, or an output\n"
    "that cannot be written; then no file is left.\n"
    ".SH ENVIRONMENT\n"
    ".TP\n.B NO_COLOR\nAny value: no colors on a terminal.\n"
    ".TP\n.B TZ\nTime zone of the local times beside UTC.\n"
    ".TP\n.B FRAMEWATCH_DATA\nFolder of the ground motions for\n.B framewatch reproduce\n"
    ".SH FILES\n"
    ".TP\n.I /etc/framewatch/building.toml\nThe building, for the services\n"
    ".I framewatch.service\nand\n.IR framewatch\\-serve.service ,\nwhich do not start without it.\n"
    ".TP\n.I /etc/framewatch/framewatch.env\nFurther options of the services.\n"
    ".TP\n.I /var/lib/framewatch/state\nThe learned state of the building, kept over a restart.\n"
    ".TP\n.I /run/framewatch\nSockets where the service accepts commands\n.RB ( \"framewatch "
    "acknowledge\" )\n"
    "from root and from members of the group\n.IR framewatch\\-operators .\n"
    ".SH SEE ALSO\n.I /usr/share/doc/framewatch/operate.md.gz\n";

struct HelpArguments {
  std::string command;
  bool man = false;
};

/// A failed write is found at the end of the program; fmt::print() would throw.
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

std::string program_man_page(const std::vector<CommandEntry>& commands) {
  std::string out = heading("framewatch") +
                    ".SH NAME\nframewatch \\- stiffness and damping of a building from its "
                    "accelerometers\n"
                    ".SH SYNOPSIS\n.B framewatch\n.I COMMAND\n.RI [ OPTION ...]\n"
                    ".SH DESCRIPTION\n"
                    "Estimates the stiffness and damping of every vertical frame and floor panel "
                    "of a building\nwhile it moves. Each command has a manual page, such as\n"
                    ".BR framewatch\\-run (1).\n.SH COMMANDS\n";
  for (const CommandEntry& command : commands)
    out += fmt::format(".TP\n.BR framewatch\\-{} (1)\n{}\n", command.name, roff(command.purpose));
  return out + kStreams + kRest;
}

std::string command_man_page(const std::string& program, const CommandEntry& command) {
  std::string name = program + " " + command.name;
  std::replace(name.begin(), name.end(), ' ', '-');
  std::string out =
      heading(name) + fmt::format(".SH NAME\n{} \\- {}\n.SH SYNOPSIS\n{}.SH OPTIONS\n", roff(name),
                                  roff(command.purpose), synopsis(program, command));
  for (const OptionEntry& option : command.options) out += option_item(option);
  return out + footer_sections(command.footer) + ".SH SEE ALSO\n.BR framewatch (1)\n";
}

void add_help(CommandList& commands) {
  HelpArguments& arguments = commands.arguments<HelpArguments>();
  CLI::App* command = commands.add("help", "show how to use the program or a command");
  command->footer(commands.program() == "framewatch" ? "Examples:\n"
                                                       "  framewatch help replay\n"
                                                       "  framewatch help replay --man | man -l -"
                                                     : "");
  command->add_option("COMMAND", arguments.command, "the command; without it, list all commands");
  command->add_flag("--man", arguments.man, "write a manual page in the format of man(7)");
  commands.set_action(command,
                      [&arguments, command] { return help(*command->get_parent(), arguments); });
}

void add_completion(CommandList& commands) {
  std::string& shell = commands.arguments<std::string>();
  CLI::App* command = commands.add(
      "completion", "print a script that completes commands, options and values in a shell");
  command->footer(
      "The Debian package installs these scripts.\nExamples:\n  source <(framewatch completion "
      "bash)\n  framewatch completion fish > ~/.config/fish/completions/framewatch.fish");
  command->add_option("SHELL", shell, "bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  commands.set_action(command, [&shell, command] {
    print(completion_script(shell, command_entries(*command->get_parent())));
    return 0;
  });
}

}  // namespace framewatch::daemon
