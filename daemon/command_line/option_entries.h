// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}  // namespace CLI

namespace framewatch::daemon {

/// An option or argument of a command, as listed by --help.
struct OptionEntry {
  std::string name;                  ///< --out; of an argument LOG
  std::string value;                 ///< value name: FILE, INT; empty for a flag
  std::vector<std::string> choices;  ///< the allowed words, if only some are allowed
  std::string text;                  ///< what it is, on one line
  bool is_argument = false;          ///< its place says what it is
  bool is_required = false;
  bool takes_many = false;
  bool value_may_lack = false;
};

struct CommandEntry {
  std::string name;
  std::string purpose;  ///< on one line
  std::string footer;   ///< exit status and examples, of several lines
  std::vector<OptionEntry> options;
  std::vector<std::string> unlisted;  ///< options that --help does not list: for our own tools
};

/// Every command of the program in the order of --help, without what is hidden.
std::vector<CommandEntry> command_entries(const CLI::App& app);

/// A completion script for a shell: "bash", "zsh" or "fish".
std::string completion_script(const std::string& shell, const std::vector<CommandEntry>& commands);

/// The manual page framewatch(1), in the language of man(7).
std::string program_man_page(const std::vector<CommandEntry>& commands);
/// The manual page of one command of `program`, as it is called (framewatch):
/// framewatch-<command>(1).
std::string command_man_page(const std::string& program, const CommandEntry& command);

/// Returns arguments that are neither a command nor an option of the command, each with the
/// probable meaning. Returns an empty list if all are known. `program`: its name in messages.
std::vector<std::string> misspelt(const std::string& program,
                                  const std::vector<CommandEntry>& commands,
                                  const std::vector<std::string>& arguments);
/// Returns the message about a word that should be a command.
std::string no_such_command(const std::string& program, const std::vector<CommandEntry>& commands,
                            const std::string& word);

}  // namespace framewatch::daemon
