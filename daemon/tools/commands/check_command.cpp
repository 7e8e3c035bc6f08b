#include "daemon/tools/commands/check_command.h"

#include <utility>

#include <fmt/core.h>

#include "daemon/base/file_digest.h"
#include "daemon/base/printable.h"
#include "daemon/config/keys/options_markdown.h"
#include "daemon/config/read_config.h"
#include "daemon/config/sections/config_problems.h"
#include "daemon/tools/commands/check_report.h"
#include "daemon/tools/commands/effects_markdown.h"
#include "daemon/tools/simulation/scenario.h"

namespace framewatch::daemon {
namespace {

/// What cannot be read, or is no TOML, is a configuration whose problems are told.
bool names_scenario(const std::string& path) {
  std::string error;
  std::vector<TextProblem> ignored;
  const std::optional<std::string> text = read_text_file(path, error);
  const std::optional<TomlValue> document = text ? parse_toml(*text, ignored) : std::nullopt;
  return document && is_scenario(*document);
}

/// The building of a scenario in which nothing is wrong.
std::optional<Config> config_of_scenario(const std::string& path,
                                         std::vector<ConfigProblem>& problems) {
  std::optional<Scenario> scenario = load_scenario(path, problems);
  if (!scenario) return std::nullopt;
  return std::move(scenario->config);
}

}  // namespace

int check_command(const CheckArguments& arguments) {
  if (arguments.print_options_markdown) {
    fmt::print("{}", options_markdown());
    return 0;
  }
  if (arguments.print_effects_markdown) {
    fmt::print("{}", effects_markdown());
    return 0;
  }
  std::vector<ConfigProblem> problems;
  const bool scenario = names_scenario(arguments.config);
  const std::optional<Config> config = scenario ? config_of_scenario(arguments.config, problems)
                                                : load_config(arguments.config, problems);
  std::optional<CheckReport> report;
  if (config) report = make_check_report(*config, arguments.advise);
  if (arguments.json) {
    fmt::print("{}", to_json(arguments.config, report, problems));
  } else if (report) {
    if (scenario)
      fmt::print("{}: a scenario for framewatch simulate, good; its building:\n",
                 printable(arguments.config));
    fmt::print("{}", printable_lines(to_text(*report)));
    const std::string label = toned(Tone::doubtful, "warning:", stdout);
    for (const std::string& warning : report->warnings)
      fmt::print("{} {}\n", label, printable_lines(warning));
  } else {
    print_problems(problems);
    fmt::print(stderr, "{}: {}{} problem{}\n", arguments.config, scenario ? "a scenario, " : "",
               problems.size(), problems.size() == 1 ? "" : "s");
  }
  return report ? 0 : 2;
}

}  // namespace framewatch::daemon
