// SPDX-License-Identifier: MIT
#include "daemon/monitor/actions/tell_command.h"

#include <limits>
#include <optional>
#include <vector>

#include <framewatch/event_t.hpp>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/exit_code.h"
#include "daemon/base/printable.h"
#include "daemon/config/config.h"
#include "daemon/config/sections/config_problems.h"
#include "daemon/monitor/actions/receivers.h"
#include "daemon/monitor/events/event_messages.h"

namespace framewatch::daemon {
int tell_command(const TellArguments& a) {
  std::vector<ConfigProblem> problems;
  const std::optional<Config> config = load_config(a.config, problems);
  print_problems(problems);
  if (!config) return kBadInput;
  if (!config->actions) return refuse("tell", a.config + " has no [actions]");
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
  const auto report = [&](const char* receiver, const DeliveryResult& result) {
    fmt::print("{:<8} {}\n", receiver,
               result.trouble.empty() ? "delivered" : printable(result.trouble));
    good = good && result.trouble.empty();
  };
  if (!config->actions->command.empty())
    report("command",
           run_hook(*config->actions, json + "\n", event_environment(event, building), never));
  if (!config->actions->webhook.empty())
    report("webhook", post_webhook(*config->actions, json, never));
  return good ? 0 : kFailed;
}

}  // namespace framewatch::daemon
