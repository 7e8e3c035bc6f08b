// SPDX-License-Identifier: MIT
#include "daemon/monitor/actions/action_report.h"

#include <lcm/lcm-cpp.hpp>

#include "daemon/monitor/actions/receivers.h"
#include "daemon/monitor/events/event_messages.h"

namespace framewatch::daemon {

ActionReport::ActionReport(const Config& config, lcm::LCM& lcm)
    : building_(config.pipeline.structure.name), prefix_(config.lcm.prefix), lcm_(lcm) {
  reconfigure(config);
}

void ActionReport::reconfigure(const Config& config) {
  settings_ = config.actions;
  const ActionSettings settings = settings_.value_or(ActionSettings{});
  const std::string& building = building_;
  if (!settings.command.empty() && !command_)
    command_.emplace("command", [building](const ActionSettings& s, const event_t& e,
                                           const Abandoned& abandoned) {
      return run_hook(s, event_json(e, building) + "\n", event_environment(e, building), abandoned);
    });
  if (!settings.webhook.empty() && !webhook_)
    webhook_.emplace("webhook", [building](const ActionSettings& s, const event_t& e,
                                           const Abandoned& abandoned) {
      return post_webhook(s, event_json(e, building), abandoned);
    });
  // A command that failed halfway is not repeated: it might do its first half twice.
  if (command_) command_->configure(settings, 0);
  if (webhook_) webhook_->configure(settings, settings.webhook_patience_s);
}

void ActionReport::raised_before(const RaisedEvents& raised) {
  for (const event_t& e : raised.all())
    for (std::optional<Notifier>* notifier : {&command_, &webhook_})
      if (*notifier) (*notifier)->delivered_before(e);
}

void ActionReport::event(const event_t& event, bool acknowledged) {
  if (!settings_) return;
  if (command_ && !settings_->command.empty()) command_->event(event, acknowledged);
  if (webhook_ && !settings_->webhook.empty()) webhook_->event(event, acknowledged);
}

void ActionReport::acknowledged(const event_t& event) {
  for (std::optional<Notifier>* notifier : {&command_, &webhook_})
    if (*notifier) (*notifier)->acknowledged(event);
}

void ActionReport::update(std::int64_t now_us) {
  if (!settings_ || !second_.due(now_us)) return;
  const action_status_t now = status(now_us);
  lcm_.publish(prefix_ + "ACTIONS", &now);
}

action_status_t ActionReport::status(std::int64_t now_us) const {
  action_status_t out{};
  out.time_us = now_us;
  const auto add = [&](const char* name, const std::optional<Notifier>& notifier) {
    if (!notifier) return;
    const Notifier::Counters c = notifier->counters();
    out.name.emplace_back(name);
    out.told.push_back(c.told);
    out.lost.push_back(c.lost);
    out.merged.push_back(c.merged);
    out.waiting.push_back(c.waiting);
    out.lost_us.push_back(c.lost_us);
    out.trouble.push_back(c.trouble);
  };
  if (!settings_->command.empty()) add("command", command_);
  if (!settings_->webhook.empty()) add("webhook", webhook_);
  out.ways = static_cast<std::int32_t>(out.name.size());
  return out;
}

}  // namespace framewatch::daemon
