// SPDX-License-Identifier: MIT
#include "daemon/command_line/option_entries.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include "daemon/base/printable.h"
#include "daemon/config/keys/suggest.h"

namespace framewatch::daemon {
namespace {

/// Returns "did you mean replay, repair or report?". Empty if no name is close.
std::string meant(const std::string& word, const std::vector<std::string>& known) {
  std::vector<std::string> near;
  for (const std::string& candidate : known)
    if (candidate.starts_with(word)) near.push_back(candidate);
  if (const std::string one = nearest(word, known); near.empty() && !one.empty())
    near.push_back(one);
  std::string list;
  for (std::size_t i = 0; i < near.size(); ++i)
    list += (i == 0 ? "" : i + 1 == near.size() ? " or " : ", ") + near[i];
  return list.empty() ? "" : fmt::format("did you mean {}?", list);
}

std::string no_such_option(const std::string& program, const CommandEntry& command,
                           const std::string& word) {
  std::vector<std::string> known{"--help"};
  for (const OptionEntry& option : command.options)
    if (!option.is_argument) known.push_back(option.name);
  const auto is_in = [&](const std::vector<std::string>& names) {
    return std::find(names.begin(), names.end(), word) != names.end();
  };
  if (is_in(known) || is_in(command.unlisted) || word == "-h") return {};
  const std::string dashed = word.starts_with("--") ? word : "-" + word;
  const std::string advice = meant(dashed, known);
  return fmt::format(
      "there is no option {}: {}", printable(word),
      !advice.empty() ? advice : fmt::format("{} help {} lists them", program, command.name));
}

bool is_option(const std::string& argument) {
  return argument.size() > 1 && argument[0] == '-' && argument != "--" &&
         (argument[1] == '-' || std::isalpha(static_cast<unsigned char>(argument[1])) != 0);
}

std::string on_one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

/// Returns the words of "TEXT:{start,stop}", CLI11's type name of an option with fixed words.
std::vector<std::string> choices_in(const std::string& type) {
  const std::size_t begin = type.find('{'), end = type.find('}');
  if (begin == std::string::npos || end == std::string::npos) return {};
  return CLI::detail::split(type.substr(begin + 1, end - begin - 1), ',');
}

OptionEntry entry_of(const CLI::Option& option) {
  OptionEntry entry;
  entry.is_argument = option.get_positional();
  entry.name = entry.is_argument ? option.get_name(true) : "--" + option.get_lnames().front();
  entry.text = on_one_line(option.get_description());
  entry.is_required = option.get_required();
  entry.takes_many = option.get_items_expected_max() > 1;
  entry.value_may_lack = option.get_items_expected_min() == 0;
  const std::string type = option.get_type_name();
  entry.choices = choices_in(type);
  if (option.get_items_expected_max() > 0 && !entry.is_argument)
    entry.value = !entry.choices.empty() ? "WORD" : type.substr(0, type.find(':'));
  std::erase_if(entry.value, [](char c) { return c == '[' || c == ']'; });
  if (const std::string initial = option.get_default_str(); !initial.empty())
    entry.text += " (default: " + initial + ")";
  return entry;
}

}  // namespace

std::string no_such_command(const std::string& program, const std::vector<CommandEntry>& commands,
                            const std::string& word) {
  std::vector<std::string> known;
  for (const CommandEntry& command : commands) known.push_back(command.name);
  if (std::find(known.begin(), known.end(), word) != known.end()) return {};
  const std::string advice = meant(word, known);
  return fmt::format("there is no command {}: {}", printable(word),
                     !advice.empty() ? advice : program + " help lists them");
}

std::vector<std::string> misspelt(const std::string& program,
                                  const std::vector<CommandEntry>& commands,
                                  const std::vector<std::string>& arguments) {
  CommandEntry chosen;
  chosen.options.emplace_back().name = "--version";
  std::vector<std::string> out;
  for (const std::string& argument : arguments) {
    if (argument == "--") break;
    if (is_option(argument)) {
      const std::string why =
          no_such_option(program, chosen, argument.substr(0, argument.find('=')));
      if (!why.empty()) out.push_back(why);
    } else if (chosen.name.empty()) {
      const std::string why = no_such_command(program, commands, argument);
      if (!why.empty()) return {why};
      chosen = *std::find_if(commands.begin(), commands.end(),
                             [&](const CommandEntry& c) { return c.name == argument; });
    }
  }
  return out;
}

std::vector<CommandEntry> command_entries(const CLI::App& app) {
  std::vector<CommandEntry> out;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    CommandEntry entry{command->get_name(),
                       on_one_line(command->get_description()),
                       command->get_footer(),
                       {},
                       {}};
    for (const CLI::Option* option : command->get_options())
      if (option->get_group().empty())
        entry.unlisted.push_back("--" + option->get_lnames().front());
      else
        entry.options.push_back(entry_of(*option));
    out.push_back(std::move(entry));
  }
  for (CommandEntry& command : out)
    for (OptionEntry& option : command.options)
      if (option.is_argument && option.name == "COMMAND")
        for (const CommandEntry& any : out) option.choices.push_back(any.name);
  return out;
}

}  // namespace framewatch::daemon
