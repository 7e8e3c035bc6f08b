// SPDX-License-Identifier: MIT
#include "daemon/monitor/actions/action_report.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include <lcm/lcm-cpp.hpp>

#include "daemon/monitor/actions/receivers.h"
#include "daemon/monitor/actions/webhook.h"
#include "daemon/monitor/events/event_messages.h"

namespace framewatch::daemon {
namespace {

/// Returns a function that sends the e-mail about an event, with what shows it.
Notifier::Deliver email_deliverer(const std::string& building, const EventSources& sources) {
  struct State {
    EmailRound round;
    Email email;
  };
  return [building, sources, state = std::make_shared<State>()](
             const ActionSettings& s, const event_t& e, const Abandoned& abandoned) {
    Email email = event_email(e, building);
    if (email.id != state->email.id) {  // a repetition has its picture already
      if (auto picture = event_picture(sources, e, abandoned))
        email.attachments.push_back(*std::move(picture));
      state->email = std::move(email);
    }
    return state->round.send(s.account, s.email, state->email, abandoned);
  };
}

}  // namespace

ActionReport::ActionReport(const Config& config, const std::string& url, lcm::LCM& lcm)
    : building_(config.pipeline.structure.name),
      prefix_(config.lcm.prefix),
      lcm_(lcm),
      sources_(event_sources(config)),
      url_(url) {
  const std::string& building = building_;
  // A command that failed halfway is not repeated: it might do its first half twice.
  receivers_.push_back(
      {ActionSettings::kCommand,
       [building](const ActionSettings& s, const event_t& e, const Abandoned& abandoned) {
         return run_hook(s, event_json(e, building) + "\n", event_environment(e, building),
                         abandoned);
       },
       [](const ActionSettings&) { return 0.0; }});
  receivers_.push_back(
      {ActionSettings::kWebhook,
       [building](const ActionSettings& s, const event_t& e, const Abandoned& abandoned) {
         return post_webhook(s, e, building, abandoned);
       },
       [](const ActionSettings& s) { return s.webhook_patience_s; }});
  receivers_.push_back({ActionSettings::kEmail, email_deliverer(building, sources_),
                        [](const ActionSettings& s) { return s.account.patience_s; }});
  reconfigure(config);
}

void ActionReport::reconfigure(const Config& config) {
  settings_ = config.actions;
  const ActionSettings settings = settings_.value_or(ActionSettings{});
  for (Receiver& r : receivers_) {
    if (settings.has(r.name) && !r.notifier)
      r.notifier = std::make_unique<Notifier>(r.name, r.deliver);
    if (r.notifier) r.notifier->configure(settings, r.patience_s(settings));
  }
  escalation_.configure(std::max<std::size_t>(1, settings.escalate.size()),
                        settings.escalate_after_min);
  quiet_ = QuietHours(settings);
  well_.configure(config, url_);
  months_.configure(config);
}

std::size_t ActionReport::place_of(const Receiver& receiver) const {
  const std::vector<std::string>& order = settings_->escalate;
  const auto found = std::find(order.begin(), order.end(), receiver.name);
  return found == order.end() ? 0 : static_cast<std::size_t>(found - order.begin());
}

void ActionReport::raised_before(const RaisedEvents& raised) {
  for (const event_t& e : raised.all()) {
    for (const Receiver& r : receivers_)
      if (r.notifier) r.notifier->delivered_before(e);
    if (raised.acknowledgement(e.id) == nullptr) escalation_.event(e, false, steady_clock_us());
  }
}

void ActionReport::event(const event_t& event, bool acknowledged) {
  if (!settings_) return;
  const std::size_t told = escalation_.event(event, acknowledged, steady_clock_us());
  for (const Receiver& r : receivers_)
    if (tells(r) && place_of(r) < told) r.notifier->event(event, acknowledged);
}

void ActionReport::acknowledged(const event_t& event) {
  escalation_.acknowledged(event);
  for (const Receiver& r : receivers_)
    if (r.notifier) r.notifier->acknowledged(event);
}

void ActionReport::escalate() {
  for (const Escalation::Due& due :
       escalation_.due(quiet_.least_severity(host_clock_us()), steady_clock_us()))
    for (const Receiver& r : receivers_)
      if (tells(r) && place_of(r) == due.receiver) r.notifier->event(due.event, false);
}

/// PagerDuty would open an incident every day.
void ActionReport::tell_well(const event_t& event) {
  for (const Receiver& r : receivers_)
    if (tells(r) && (r.name != std::string_view(ActionSettings::kWebhook) ||
                     settings_->webhook_format != WebhookFormat::pagerduty))
      r.notifier->event(event, false);
}

void ActionReport::update(std::int64_t now_us) {
  if ((!settings_ && !months_.wanted()) || !second_.due(now_us)) return;
  months_.update(now_us);
  if (settings_) {
    escalate();
    if (const std::optional<event_t> well = well_.update(now_us)) tell_well(*well);
  }
  const action_status_t now = status(now_us);
  lcm_.publish(prefix_ + "ACTIONS", &now);
}

action_status_t ActionReport::status(std::int64_t now_us) const {
  action_status_t out{};
  out.time_us = now_us;
  for (const Receiver& r : receivers_) {
    if (!tells(r)) continue;
    const Notifier::Counters c = r.notifier->counters();
    out.name.emplace_back(r.name);
    out.told.push_back(c.told);
    out.lost.push_back(c.lost);
    out.merged.push_back(c.merged);
    out.waiting.push_back(c.waiting);
    out.lost_us.push_back(c.lost_us);
    out.trouble.push_back(c.trouble);
  }
  if (months_.wanted()) {
    out.name.emplace_back("report");
    out.told.push_back(months_.done());
    out.lost.push_back(0);
    out.merged.push_back(0);
    out.waiting.push_back(0);
    out.lost_us.push_back(0);
    out.trouble.push_back(months_.trouble());
  }
  out.ways = static_cast<std::int32_t>(out.name.size());
  return out;
}

}  // namespace framewatch::daemon
