#include "daemon/command_line/option_entries.h"

#include <algorithm>
#include <utility>

#include <CLI/CLI.hpp>

namespace framewatch::daemon {
namespace {

std::string on_one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

/// The words of "TEXT:{start,stop}", which is how CLI11 calls what must be one of them.
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
