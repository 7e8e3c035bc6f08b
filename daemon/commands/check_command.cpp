#include "daemon/commands/check_command.h"

#include <fmt/core.h>

#include "daemon/base/printable.h"
#include "daemon/commands/check_report.h"
#include "daemon/commands/effects_markdown.h"
#include "daemon/config/config_problems.h"
#include "daemon/keys/options_markdown.h"

namespace framewatch::daemon {

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
  const std::optional<Config> config = load_config(arguments.config, problems);
  std::optional<CheckReport> report;
  if (config) report = make_check_report(*config);
  if (arguments.json) {
    fmt::print("{}", to_json(arguments.config, report, problems));
  } else if (report) {
    fmt::print("{}", printable_lines(to_text(*report)));
  } else {
    print_problems(problems);
    fmt::print(stderr, "{}: {} problem{}\n", arguments.config, problems.size(),
               problems.size() == 1 ? "" : "s");
  }
  return report ? 0 : 2;
}

}  // namespace framewatch::daemon
