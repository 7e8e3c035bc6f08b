// SPDX-License-Identifier: MIT
#include "daemon/monitor/actions/daily_well.h"

#include <chrono>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/monitor/actions/notifier.h"
#include "daemon/monitor/events/event_messages.h"
#include "drivers/files/caught.h"
#include "drivers/lcm/lcm_source.h"

namespace framewatch::daemon {
namespace {

constexpr std::int64_t kListenForWell_us = 10 * kSecond_us;
constexpr int kWellPoll_ms = 100;
constexpr int kLate_min = 5;

event_t message_of(bool well, const std::string& text, std::int64_t now_us) {
  event_t e{};
  e.id = e.time_us = e.since_us = now_us;
  e.state = event_state::cleared;
  e.severity = well ? severity::information : severity::warning;
  e.kind = kWellKind;
  e.value = e.std_error = std::numeric_limits<double>::quiet_NaN();
  e.message = text;
  return e;
}

event_t listen(const Config& config, const std::string& url, const std::atomic<bool>& stop) {
  std::string error;
  const auto lcm =
      drivers::open_lcm(url.empty() ? config.lcm.url : url, config.lcm.reception, error);
  if (!lcm) return message_of(false, "not well: cannot listen on LCM: " + error, host_clock_us());
  Heard heard(config);
  drivers::LcmSource source(
      *lcm, heard.channels(), config.lcm.queue_capacity,
      [&](const drivers::LcmMessage& m) { heard.message(m.channel, m.data, m.size); });
  for (const std::int64_t end_us = steady_clock_us() + kListenForWell_us;
       !stop && !heard.enough() && steady_clock_us() < end_us;)
    if (!source.handle(kWellPoll_ms)) break;
  return well_event(heard, config, host_clock_us());
}

}  // namespace

event_t well_event(const Heard& heard, const Config& config, std::int64_t now_us) {
  if (!heard.service)
    return message_of(false, "not well: no messages of framewatch run arrive on LCM", now_us);
  const std::vector<std::string> odd =
      oddities(heard, config, now_us, [](const event_t& e) { return e.message; });
  const std::string up = span_text(1e-6 * static_cast<double>(now_us - heard.service->started_us));
  if (odd.empty())
    return message_of(true,
                      fmt::format("all is well: {} channels measure, running for {}",
                                  heard.service->name.size(), up),
                      now_us);
  std::string text = "not well: ";
  for (std::size_t i = 0; i < odd.size(); ++i) text += (i == 0 ? "" : "; ") + odd[i];
  return message_of(false, text, now_us);
}

DailyTime::DailyTime(const std::string& at, const std::string& zone)
    : at_min_(read_clock_time(at)), zone_(TimeZone::find(zone)) {}

bool DailyTime::due(std::int64_t now_us) {
  if (!at_min_ || !zone_) return false;
  const int past_min = zone_->minute_of_day(now_us) - *at_min_;
  std::string today = zone_->day(now_us);
  if (done_.empty() && (past_min < 0 || past_min >= kLate_min)) {
    done_ = past_min < 0 ? "before" : today;
    return false;
  }
  if (past_min < 0 || done_ == today) return false;
  done_ = std::move(today);
  return true;
}

DailyWell::~DailyWell() {
  stop_ = true;
}

void DailyWell::configure(const Config& config, const std::string& url) {
  const ActionSettings settings = config.actions.value_or(ActionSettings{});
  config_ = std::make_shared<const Config>(config);
  url_ = url;
  if (at_ == settings.well_at && time_zone_ == settings.time_zone) return;
  at_ = settings.well_at;
  time_zone_ = settings.time_zone;
  time_ = DailyTime(at_, time_zone_);
}

std::optional<event_t> DailyWell::update(std::int64_t now_us) {
  if (!listening_.valid()) {
    if (!time_.due(now_us)) return std::nullopt;
    const std::string thrown = drivers::caught([&] {
      listening_ = std::async(std::launch::async, [this, config = config_, url = url_] {
        return listen(*config, url, stop_);
      });
    });
    if (thrown.empty()) return std::nullopt;
    return message_of(false, "not well: cannot start a thread: " + thrown, now_us);
  }
  if (listening_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
    return std::nullopt;
  std::optional<event_t> out;
  const std::string thrown = drivers::caught([&] { out = listening_.get(); });
  if (!thrown.empty()) out = message_of(false, "not well: " + thrown, now_us);
  return out;
}

}  // namespace framewatch::daemon
