// SPDX-License-Identifier: MIT
#include <string_view>

#include <fmt/format.h>

#include "daemon/command_line/option_entries.h"

namespace framewatch::daemon {
namespace {

std::string escaped(const std::string& text, std::string_view special, const char* by) {
  std::string out;
  for (const char c : text) {
    if (special.find(c) != std::string_view::npos) out += by;
    out += c;
  }
  return out;
}

/// Quotes text for '...' of sh: each quote ends the string, is escaped, and begins it again.
std::string quoted(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return "'" + out + "'";
}

std::string words_of(const std::vector<CommandEntry>& commands) {
  std::string out;
  for (const CommandEntry& command : commands) out += (out.empty() ? "" : " ") + command.name;
  return out;
}

std::string options_of(const CommandEntry& command) {
  std::string out = "--help";
  for (const OptionEntry& option : command.options)
    if (!option.is_argument) out += " " + option.name;
  return out;
}

bool is_number(const OptionEntry& option) {
  return option.value == "INT" || option.value == "UINT" || option.value == "FLOAT";
}

/// Returns the words that an argument can be. Empty for a file.
std::vector<std::string> argument_words(const CommandEntry& command) {
  for (const OptionEntry& option : command.options)
    if (option.is_argument && !option.choices.empty()) return option.choices;
  return {};
}

std::string bash_values(const CommandEntry& command) {
  std::string out;
  for (const OptionEntry& option : command.options) {
    const std::string when = fmt::format("    {}:{}) ", command.name, option.name);
    if (!option.choices.empty() && !option.is_argument)
      out += fmt::format("{}COMPREPLY=($(compgen -W {} -- \"$cur\")); return ;;\n", when,
                         quoted(fmt::format("{}", fmt::join(option.choices, " "))));
    else if (option.value == "DIR")
      out += when + "compopt -o filenames; COMPREPLY=($(compgen -d -- \"$cur\")); return ;;\n";
    else if (is_number(option))
      out += when + "return ;;\n";
  }
  return out;
}

std::string bash_script(const std::vector<CommandEntry>& commands) {
  std::string values, options, arguments;
  for (const CommandEntry& command : commands) {
    values += bash_values(command);
    options += fmt::format("    {}) options={} ;;\n", command.name, quoted(options_of(command)));
    if (const auto words = argument_words(command); !words.empty())
      arguments += fmt::format("    {}) COMPREPLY=($(compgen -W {} -- \"$cur\")); return ;;\n",
                               command.name, quoted(fmt::format("{}", fmt::join(words, " "))));
  }
  return fmt::format(
      R"(# Completion of framewatch for bash: made by `framewatch completion bash`.
_framewatch() {{
  local cur=${{COMP_WORDS[COMP_CWORD]}} prev=${{COMP_WORDS[COMP_CWORD - 1]}} command= options= i
  COMPREPLY=()
  for ((i = 1; i < COMP_CWORD; ++i)); do
    [[ ${{COMP_WORDS[i]}} == -* ]] || {{ command=${{COMP_WORDS[i]}} && break; }}
  done
  if [[ -z $command ]]; then
    COMPREPLY=($(compgen -W {commands} -- "$cur"))
    return
  fi
  case $command:$prev in
{values}  esac
  case $command in
{options}  esac
  if [[ $cur == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$cur"))
    return
  fi
  case $command in
{arguments}  esac
  compopt -o filenames
  mapfile -t COMPREPLY < <(compgen -f -- "$cur")
}}
complete -F _framewatch framewatch
)",
      fmt::arg("commands", quoted(words_of(commands) + " --help --version")),
      fmt::arg("values", values), fmt::arg("options", options), fmt::arg("arguments", arguments));
}

std::string zsh_action(const OptionEntry& option) {
  if (!option.choices.empty()) return fmt::format("({})", fmt::join(option.choices, " "));
  if (option.value == "DIR") return "_files -/";
  return is_number(option) ? "" : "_files";
}

std::string zsh_option(const OptionEntry& option) {
  const std::string text = escaped(option.text, "[]\\:", "\\");
  if (option.is_argument) {
    if (!option.takes_many) return quoted(fmt::format(":{}:{}", option.name, zsh_action(option)));
    return quoted(fmt::format("*:{}:{}", option.name, zsh_action(option)));
  }
  const std::string many = option.takes_many ? "*" : "";
  if (option.value.empty()) return quoted(fmt::format("{}[{}]", option.name, text));
  return quoted(fmt::format("{}{}[{}]:{}{}:{}", many, option.name, text,
                            option.value_may_lack ? ":" : "", option.value, zsh_action(option)));
}

std::string zsh_script(const std::vector<CommandEntry>& commands) {
  std::string names, cases;
  for (const CommandEntry& command : commands) {
    names +=
        fmt::format("    {}\n", quoted(command.name + ":" + escaped(command.purpose, ":\\", "\\")));
    std::string options = "'(- *)--help[how it is used]'";
    for (const OptionEntry& option : command.options)
      options += " \\\n        " + zsh_option(option);
    cases += fmt::format("    {})\n      _arguments {} ;;\n", command.name, options);
  }
  return fmt::format(R"(#compdef framewatch
# Completion of framewatch for zsh: made by `framewatch completion zsh`.
_framewatch() {{
  local -a commands
  commands=(
{names}  )
  if (( CURRENT == 2 )); then
    _describe -t commands command commands
    _arguments '--help[the commands]' '--version[its version]'
    return
  fi
  local command=$words[2]
  shift words
  (( CURRENT-- ))
  case $command in
{cases}  esac
}}
if [[ $funcstack[1] == _framewatch ]]; then
  _framewatch "$@"
else
  compdef _framewatch framewatch
fi
)",
                     fmt::arg("names", names), fmt::arg("cases", cases));
}

std::string fish_quoted(const std::string& text) {
  return "'" + escaped(text, "'\\", "\\") + "'";
}

std::string fish_script(const std::vector<CommandEntry>& commands) {
  std::string out =
      "# Completion of framewatch for fish: made by `framewatch completion fish`.\n"
      "function __framewatch_command_is\n"
      "  set -l words (commandline -opc)\n"
      "  test (count $words) -gt 1; and test $words[2] = $argv[1]\n"
      "end\n"
      "complete -c framewatch -n __fish_use_subcommand -f -l help -d 'the commands'\n"
      "complete -c framewatch -n __fish_use_subcommand -f -l version -d 'its version'\n";
  for (const CommandEntry& command : commands) {
    out += fmt::format("complete -c framewatch -n __fish_use_subcommand -f -a {} -d {}\n",
                       command.name, fish_quoted(command.purpose));
    const std::string begin =
        fmt::format("complete -c framewatch -n '__framewatch_command_is {}'", command.name);
    out += begin + " -f -l help -d 'how it is used'\n";
    for (const OptionEntry& option : command.options) {
      const std::string words =
          option.choices.empty()
              ? ""
              : " -a " + fish_quoted(fmt::format("{}", fmt::join(option.choices, " ")));
      if (option.is_argument) {
        if (!words.empty()) out += begin + " -f" + words + "\n";
        continue;
      }
      std::string value = option.value.empty() ? " -f" : " -r -F";
      if (!words.empty() || is_number(option)) value = " -x" + words;
      if (option.value == "DIR") value = " -x -a '(__fish_complete_directories)'";
      out += fmt::format("{} -l {}{} -d {}\n", begin, option.name.substr(2), value,
                         fish_quoted(option.text));
    }
  }
  return out;
}

}  // namespace

std::string completion_script(const std::string& shell, const std::vector<CommandEntry>& commands) {
  return shell == "bash"  ? bash_script(commands)
         : shell == "zsh" ? zsh_script(commands)
                          : fish_script(commands);
}

}  // namespace framewatch::daemon
