// SPDX-License-Identifier: MIT
#include "daemon/monitor/actions/tell_command.h"

#include <cstddef>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <framewatch/event_t.hpp>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/exit_code.h"
#include "daemon/base/printable.h"
#include "daemon/config/config.h"
#include "daemon/config/sections/config_problems.h"
#include "daemon/monitor/actions/email.h"
#include "daemon/monitor/actions/event_picture.h"
#include "daemon/monitor/actions/receivers.h"
#include "daemon/monitor/actions/webhook.h"
#include "daemon/monitor/events/event_messages.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kShownName = 8;

/// Prints what a receiver answered; `whom`: the person, if it tells several. Returns false if it
/// was not told.
bool report(const char* receiver, const DeliveryResult& result, const std::string& whom = "") {
  const std::string answer = result.answer.empty() ? "" : ", answer: " + result.answer;
  const std::string text = result.trouble.empty()
                               ? (whom.empty() ? "" : whom + ": ") + "delivered" + answer
                               : result.trouble;
  fmt::print("{:<{}} {}\n", receiver, kShownName, printable(text));
  std::fflush(stdout);
  return result.trouble.empty();
}

bool never() {
  return false;
}

/// Tries the webhook. An incident of PagerDuty is resolved at once.
bool try_webhook(const ActionSettings& s, event_t event, const std::string& building) {
  const char* const name = "webhook";
  if (s.webhook_format != WebhookFormat::pagerduty)
    return report(name, post_webhook(s, event, building, never));
  event.since_us -= kSecond_us;
  event.state = event_state::raised;
  if (!report(name, post_webhook(s, event, building, never))) return false;
  event.state = event_state::cleared;
  return report(name, post_webhook(s, event, building, never));
}

bool try_people(const Config& config, const event_t& event, const std::string& building) {
  Email email = event_email(event, building);
  // A stiffness of the history shows that plots arrive.
  event_t plotted = event;
  plotted.place = config.pipeline.parameters()[0].name;
  if (auto picture = event_picture(event_sources(config), plotted, never))
    email.attachments.push_back(*std::move(picture));
  bool good = true;
  for (const std::string& to : config.actions->email)
    good = report("email", send_email(config.actions->account, to, email, never), to) && good;
  return good;
}

}  // namespace

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
  const ActionSettings& settings = *config->actions;
  bool good = true;
  if (!settings.command.empty())
    good = report("command", run_hook(settings, event_json(event, building) + "\n",
                                      event_environment(event, building), never));
  if (settings.has_webhook()) good = try_webhook(settings, event, building) && good;
  if (!settings.email.empty()) good = try_people(*config, event, building) && good;
  return good ? 0 : kFailed;
}

}  // namespace framewatch::daemon
