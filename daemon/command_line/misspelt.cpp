#include <algorithm>
#include <cctype>

#include <fmt/core.h>

#include "daemon/base/printable.h"
#include "daemon/command_line/option_entries.h"
#include "daemon/config/keys/suggest.h"

namespace framewatch::daemon {
namespace {

/// "did you mean replay, repair or report?"; empty when nothing is near.
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

}  // namespace framewatch::daemon
