#include "daemon/action_report.h"

#include "daemon/event_json.h"
#include "daemon/hook_command.h"
#include "daemon/webhook.h"

namespace framewatch::daemon {

ActionReport::ActionReport(const Config& config, lcm::LCM& lcm) : config_(config), lcm_(lcm) {
  reconfigure();
}

void ActionReport::reconfigure() {
  const ActionSettings settings = config_.actions.value_or(ActionSettings{});
  const std::string& building = config_.pipeline.structure.name;
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
  // What a command did before it failed, it might do twice.
  if (command_) command_->configure(settings, 0);
  if (webhook_) webhook_->configure(settings, settings.webhook_patience_s);
}

void ActionReport::raised_before(const RaisedEvents& raised) {
  for (const event_t& e : raised.all())
    for (std::optional<ActionWay>* way : {&command_, &webhook_})
      if (*way) (*way)->told_before(e);
}

void ActionReport::event(const event_t& event, bool acknowledged) {
  if (!config_.actions) return;
  if (command_ && !config_.actions->command.empty()) command_->event(event, acknowledged);
  if (webhook_ && !config_.actions->webhook.empty()) webhook_->event(event, acknowledged);
}

void ActionReport::acknowledged(const event_t& event) {
  for (std::optional<ActionWay>* way : {&command_, &webhook_})
    if (*way) (*way)->acknowledged(event);
}

void ActionReport::look(std::int64_t now_us) {
  if (!config_.actions || !second_.due(now_us)) return;
  const action_status_t now = status(now_us);
  lcm_.publish(config_.lcm.prefix + "ACTIONS", &now);
}

action_status_t ActionReport::status(std::int64_t now_us) const {
  action_status_t out{};
  out.time_us = now_us;
  const auto add = [&](const char* name, const std::optional<ActionWay>& way) {
    if (!way) return;
    const ActionWay::Counters c = way->counters();
    out.name.emplace_back(name);
    out.told.push_back(c.told);
    out.lost.push_back(c.lost);
    out.merged.push_back(c.merged);
    out.waiting.push_back(c.waiting);
    out.lost_us.push_back(c.lost_us);
    out.trouble.push_back(c.trouble);
  };
  if (!config_.actions->command.empty()) add("command", command_);
  if (!config_.actions->webhook.empty()) add("webhook", webhook_);
  out.ways = static_cast<std::int32_t>(out.name.size());
  return out;
}

}  // namespace framewatch::daemon
