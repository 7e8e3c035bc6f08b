// SPDX-License-Identifier: MIT
#include "daemon/page/view/page_alarms.h"

#include <algorithm>
#include <utility>

#include "daemon/monitor/service/health.h"
#include "daemon/page/view/page_json.h"

namespace framewatch::daemon {

void PageAlarms::restore(const std::vector<event_t>& events) {
  for (const event_t& e : events) (void)put(e);
}

std::string PageAlarms::note(const event_t& e) {
  own_.erase(e.id);
  return put(e);
}

std::string PageAlarms::note_own(const event_t& e) {
  own_.insert(e.id);
  return put(e);
}

std::string PageAlarms::put(const event_t& e) {
  events_[e.id] = e;
  if (e.state == event_state::cleared) acknowledged_here_.erase(e.id);
  if (events_.size() > kMax) {
    // The next service_t would bring a raised event back.
    auto gone = std::find_if(events_.begin(), events_.end(), [](const auto& known) {
      return known.second.state == event_state::cleared;
    });
    if (gone == events_.end()) gone = events_.begin();
    acknowledged_here_.erase(gone->first);
    own_.erase(gone->first);
    events_.erase(gone);
  }
  return json(e);
}

std::vector<std::string> PageAlarms::still_raised(const service_t& s) {
  std::vector<std::string> out;
  const std::set<std::int64_t> raised(s.event_id.begin(), s.event_id.end());
  std::vector<event_t> gone;
  for (const auto& [id, event] : events_)
    if (event.state != event_state::cleared && !raised.contains(id) && !own_.contains(id))
      gone.push_back(event);
  for (event_t& e : gone) {
    e.state = event_state::cleared;
    e.time_us = s.time_us;
    e.message += " (framewatch run no longer reports this)";
    out.push_back(put(e));
  }
  for (std::size_t i = 0; i < s.event_id.size(); ++i) {
    const auto known = events_.find(s.event_id[i]);
    if (known != events_.end() && (known->second.state != event_state::cleared ||
                                   known->second.since_us == s.event_since_us[i]))
      continue;
    out.push_back(put(raised_event(s, i)));
  }
  return out;
}

std::vector<std::string> PageAlarms::acknowledged(acknowledged_t news) {
  if (acknowledged_ && acknowledged_->id == news.id && acknowledged_->since_us == news.since_us)
    return {};
  std::set<std::int64_t> touched = acknowledge_own(news);
  touched.insert(news.id.begin(), news.id.end());
  if (acknowledged_) touched.insert(acknowledged_->id.begin(), acknowledged_->id.end());
  acknowledged_ = std::move(news);
  std::vector<std::string> out;
  for (const std::int64_t id : touched)
    if (const event_t* event = find(id)) out.push_back(json(*event));
  return out;
}

/// Returns the raised events of the page if all events were acknowledged since the last message.
std::set<std::int64_t> PageAlarms::acknowledge_own(const acknowledged_t& news) {
  const auto all = acknowledgement_of(news, kAllEvents);
  if (!all) return {};
  const std::int64_t since_us = news.since_us[*all];
  const std::int64_t before_us = std::exchange(all_acknowledged_us_, since_us);
  // The first message may be older than the page's events.
  if (!acknowledged_ || before_us == since_us) return {};
  for (const std::int64_t id : own_)
    if (events_.at(id).state != event_state::cleared)
      acknowledged_here_[id] = {since_us, news.who[*all], news.comment[*all]};
  return own_;
}

std::string PageAlarms::acknowledge(std::int64_t id) {
  acknowledged_here_[id] = {};
  return json(events_.at(id));
}

const event_t* PageAlarms::find(std::int64_t id) const {
  const auto found = events_.find(id);
  return found == events_.end() ? nullptr : &found->second;
}

std::vector<std::string> PageAlarms::all() const {
  std::vector<std::string> out;
  for (const auto& [id, event] : events_) out.push_back(json(event));
  return out;
}

std::optional<Acknowledgement> PageAlarms::acknowledgement(const event_t& e) const {
  if (e.state == event_state::cleared) return std::nullopt;
  if (const auto at = acknowledgement_of(acknowledged_, e.id))
    return Acknowledgement{0, acknowledged_->who[*at], acknowledged_->comment[*at]};
  const auto here = acknowledged_here_.find(e.id);
  return here == acknowledged_here_.end() ? std::nullopt : std::optional(here->second);
}

std::string PageAlarms::json(const event_t& e) const {
  const std::optional<Acknowledgement> by = acknowledgement(e);
  return alarm_json(e, by.has_value(), by.value_or(Acknowledgement{}));
}

std::vector<Finding> PageAlarms::findings(const Config& config) const {
  std::vector<Finding> out;
  for (const auto& [id, event] : events_) {
    if (event.state == event_state::cleared) continue;
    out.push_back(finding_of(event, config));
    if (const auto by = acknowledgement(event)) {
      out.back().acknowledged = true;
      out.back().who = by->who;
    }
  }
  std::stable_sort(out.begin(), out.end(), [](const Finding& a, const Finding& b) {
    return a.severity != b.severity ? a.severity > b.severity : a.since_us < b.since_us;
  });
  return out;
}

}  // namespace framewatch::daemon
