#include "daemon/tell_command.h"

#include <limits>
#include <optional>
#include <vector>

#include <fmt/core.h>

#include "daemon/clocks.h"
#include "daemon/config.h"
#include "daemon/config_problems.h"
#include "daemon/event_json.h"
#include "daemon/event_words.h"
#include "daemon/exit_code.h"
#include "daemon/hook_command.h"
#include "daemon/webhook.h"

namespace framewatch::daemon {
int tell_command(const TellArguments& a) {
  std::vector<ConfigProblem> problems;
  const std::optional<Config> config = load_config(a.config, problems);
  print_problems(problems);
  if (!config) return kBadInput;
  if (!config->actions) {
    fmt::print(stderr, "framewatch tell: {} has no [actions]\n", a.config);
    return kBadInput;
  }
  event_t event{};
  event.time_us = event.since_us = event.id = host_clock_us();
  event.state = event_state::cleared;
  event.severity = severity::information;
  event.kind = "test";
  event.value = event.std_error = std::numeric_limits<double>::quiet_NaN();
  event.message = a.message;
  const std::string& building = config->pipeline.structure.name;
  const std::string json = event_json(event, building);
  const auto never = [] { return false; };
  bool good = true;
  const auto say = [&](const char* way, const Told& told) {
    fmt::print("{:<8} {}\n", way, told.trouble.empty() ? "was told" : told.trouble);
    good = good && told.trouble.empty();
  };
  if (!config->actions->command.empty())
    say("command",
        run_hook(*config->actions, json + "\n", event_environment(event, building), never));
  if (!config->actions->webhook.empty())
    say("webhook", post_webhook(*config->actions, json, never));
  return good ? 0 : kFailed;
}

}  // namespace framewatch::daemon
