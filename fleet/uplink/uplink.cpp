// SPDX-License-Identifier: MIT
#include "fleet/uplink/uplink.h"

#include <algorithm>
#include <filesystem>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/file_digest.h"
#include "daemon/base/process.h"
#include "drivers/files/encoded.h"
#include "drivers/files/number_text.h"
#include "fleet/message/address.h"
#include "fleet/uplink/outbox.h"
#include "fleet/uplink/send_window.h"

namespace framewatch::fleet {
namespace {

constexpr std::int64_t kLook_us = 1'000'000, kStore_us = 200'000, kInventory_us = daemon::kDay_us;
constexpr std::int64_t kRefused_us = 60'000'000;
constexpr const char* kRawFolder = "uplink-raw";

std::string raw_folder(const daemon::HistorySettings& history) {
  return (std::filesystem::path(history.directory) / kRawFolder).string();
}

}  // namespace

Uplink::Uplink(UplinkSettings settings, Link& link, CommandDesk::Acknowledge acknowledge,
               std::unique_ptr<RawExporter> exporter, Instant now)
    : settings_(std::move(settings)),
      link_(link),
      outbox_(settings_.history.directory, settings_.history.summary_s),
      desk_(settings_.fleet, store_, std::move(acknowledge)),
      raw_(raw_folder(settings_.history), settings_.fleet.building, settings_.fleet.raw_kbit_s,
           store_, std::move(exporter)),
      begun_(now),
      clock_us_(now.host_us) {
  const std::string& building = settings_.fleet.building;
  link_.listen(down_subject(building, ">"));
  link_.listen(down_subject("all", ">"));
}

std::vector<std::string> Uplink::channels() {
  std::vector<daemon::DaemonMessage> messages = NewestMessages::messages();
  messages.push_back(daemon::DaemonMessage::event);
  return daemon::LatestMessages("").channels(messages);
}

void Uplink::heard(std::string_view channel, std::span<const std::uint8_t> bytes) {
  const auto changed = latest_.update(channel, bytes);
  if (!changed) return;
  newest_.update(latest_, *changed, bytes);
  if (changed == daemon::DaemonMessage::event) hear_event(*latest_.event);
}

void Uplink::hear_event(const event_t& event) {
  if (live_.size() >= kMaxLive) {
    live_.pop_front();  // the history has it
    ++lost_live_;
    look_again_ = true;
  }
  live_.push_back(event);
}

void Uplink::step(Instant now) {
  if (!store_.is_open()) store(now, false);
  hear_link(now);
  store(now, false);
  collect(now);
  say_inventory(now);
  say_config();
  fill(now);
  send(now);
}

void Uplink::hear_link(Instant now) {
  const std::string inbox = link_.inbox() + ".";
  for (const Message& message : link_.take()) {
    if (message.subject.starts_with(inbox)) {
      if (const auto number = drivers::parse_integer(message.subject.substr(inbox.size())))
        hear_answer(*number, message, now);
    } else if (down_parts(message.subject)) {
      hear_command(message, now);
    }
  }
  if (link_.connections() == connections_) return;
  connections_ = link_.connections();
  rewind_ = true;
  newest_.restart();
  window_.reconnected(now.steady_us);
}

void Uplink::hear_answer(std::int64_t number, const Message& answer, Instant now) {
  const Verdict verdict = verdict_of(answer);
  if (verdict.code == 0) {
    if (auto done = window_.acknowledged(number, now.steady_us))
      note_acknowledged(*done, verdict.duplicate);
    acknowledged_us_ = now.host_us;
    return;
  }
  ++refused_;
  refusal_ = verdict.why;
  // A stream without a leader counts as a hub that does not answer.
  if (verdict.code != Verdict::kUnavailable)
    (void)window_.refused(number, now.steady_us, kRefused_us);
}

void Uplink::hear_command(const Message& command, Instant now) {
  const auto parts = down_parts(command.subject);
  Message answer;
  answer.subject = command.reply;
  const std::string text = desk_.obey(parts->kind, command, now.host_us);
  if (parts->kind == "resend") again_ = command.header(header::kRequest);
  answer.bytes.assign(text.begin(), text.end());
  if (!command.reply.empty()) (void)link_.publish(answer);
  look_again_ = desk_.changed_what_waits() || look_again_;
}

void Uplink::note_acknowledged(const Outgoing& done, bool duplicate) {
  ++acknowledged_;
  if (!done.request.empty()) raw_.acknowledged(done);
  if (done.event) unstored_events_.push_back({*done.event, duplicate});
  if (done.summary) unstored_summaries_.push_back({*done.summary, done.windows, duplicate});
  if (done.event || done.summary) unstored_keys_.insert(done.message.header(header::kKey));
}

/// Forgets the newest acknowledgements after a new connection: a hub that lost power has lost them,
/// because a server writes to the disk every two minutes.
void Uplink::begin_connection() {
  if (!store_.forget_newest(kAgainAfterLoss_us)) return;
  rewind_ = false;
  look_again_ = true;
}

void Uplink::store(Instant now, bool at_once) {
  if (!at_once && now.steady_us < store_us_) return;
  store_us_ = now.steady_us + kStore_us;
  if (!store_.is_open()) {
    store_trouble_ = store_.open(settings_.history.directory, now.host_us);
    if (!store_trouble_.empty()) {
      store_us_ = now.steady_us + kLook_us;
      return;
    }
    const auto newest_us = store_.newest_us();
    clock_us_ = std::max(clock_us_, newest_us.value_or(clock_us_));
    acknowledged_us_ = std::max(acknowledged_us_, newest_us.value_or(0));
    look_again_ = true;
  }
  if (!unstored_events_.empty() || !unstored_summaries_.empty()) {
    if (!store_.acknowledged(unstored_events_, unstored_summaries_, clock_us(now))) {
      store_trouble_ = store_.error();
      store_us_ = now.steady_us + kLook_us;
      return;
    }
    waiting_.event_count -= static_cast<std::int64_t>(unstored_events_.size());
    waiting_.period_count -= static_cast<std::int64_t>(unstored_summaries_.size());
    unstored_events_.clear();
    unstored_summaries_.clear();
    unstored_keys_.clear();
  }
  store_trouble_.clear();
  if (rewind_) begin_connection();
}

void Uplink::collect(Instant now) {
  if (!store_.is_open() || !unstored_keys_.empty() || rewind_ || now.steady_us < look_us_) return;
  const bool used_up =
      next_event_ >= waiting_.events.size() && next_period_ >= waiting_.periods.size();
  const bool more = waiting_.event_count > 0 || waiting_.period_count > 0;
  look_us_ = now.steady_us + kLook_us;
  if (!look_again_ && !(used_up && more && window_.messages() == 0) && !outbox_.has_news()) return;
  outbox_trouble_ = outbox_.collect(store_, waiting_);
  if (!outbox_trouble_.empty()) return;
  next_event_ = next_period_ = 0;
  look_again_ = false;
}

void Uplink::say_inventory(Instant now) {
  if (now.steady_us < inventory_us_ || !outbox_.newest_us()) return;
  inventory_us_ = now.steady_us + kInventory_us;
  const auto& periods_s = settings_.history.summary_s;
  const std::string text = inventory(outbox_.history(), *outbox_.newest_us(),
                                     periods_s.at(periods_s.size() > 1 ? 1 : 0));
  if (!text.empty()) newest_.set_text("inventory", "json", text);
}

/// Sends the configuration file if it is the one that the daemon runs with.
void Uplink::say_config() {
  const std::string& runs = newest_.config_sha256();
  if (!settings_.fleet.send_config || runs.empty() || runs == config_sent_) return;
  config_sent_ = runs;
  std::string error;
  const auto text = daemon::read_text_file(settings_.config, error);
  if (text && daemon::sha256(*text) == runs) newest_.set_text("config", "toml", *text);
}

/// Fills the window in the order: events, newest messages, newest summaries, older ones, raw
/// samples.
void Uplink::fill(Instant now) {
  const auto takes = [&] { return window_.takes(now.steady_us) && !waits_for_store(); };
  while (!live_.empty() && takes()) {
    add_event(live_.front(), now);
    live_.pop_front();
  }
  while (next_event_ < waiting_.events.size() && takes())
    add_event(waiting_.events[next_event_++], now);
  while (takes()) {
    auto due = newest_.due(now.steady_us);
    if (!due) break;
    Outgoing out;
    const std::string& building = settings_.fleet.building;
    out.message =
        packed(up_subject(building, due->kind), newest_key(building, due->kind, clock_us(now)),
               due->type, std::move(due->content), newest_.config_sha256());
    window_.drop(out.message.subject);
    add(std::move(out), now);
  }
  while (takes() && fill_periods(now)) {
  }
  if (store_.is_open() && takes())
    if (auto piece = raw_.next(now.steady_us, newest_.config_sha256(), window_))
      add(std::move(*piece), now);
}

bool Uplink::add_event(const event_t& event, Instant now) {
  Outgoing out;
  const std::string& building = settings_.fleet.building;
  out.event = event_key(event);
  out.message = packed(up_subject(building, "event"), message_key(building, *out.event), "event_t",
                       drivers::encoded(event), newest_.config_sha256());
  return add(std::move(out), now);
}

/// Adds one period. Returns false if none may be sent now.
bool Uplink::fill_periods(Instant now) {
  if (next_period_ >= waiting_.periods.size() ||
      window_.summaries() >= SendWindow::kMaxMessages / 2)
    return false;
  const ClosedPeriod& period = waiting_.periods[next_period_];
  const std::int64_t longest_s = settings_.history.summary_s.back();
  const std::int64_t fresh_us =
      outbox_.newest_us().value_or(0) - 3 * longest_s * daemon::kSecond_us;
  if (period.key.start_us < fresh_us) {
    if (now.steady_us < older_us_) return false;
    older_us_ = std::max(older_us_, now.steady_us - daemon::kSecond_us) +
                static_cast<std::int64_t>(daemon::kSecond_us / kOlder_hz);
  }
  ++next_period_;
  const std::string& building = settings_.fleet.building;
  const std::string key = message_key(building, period.key);
  if (window_.has(key) || unstored_keys_.contains(key)) return true;
  const auto summary = summary_message(outbox_.history(), period.key, latest_.parameters);
  if (!summary) return true;
  Outgoing out;
  out.summary = period.key;
  out.windows = period.windows;
  out.message = packed(up_subject(building, fmt::format("summary.{}", period.key.period_s)), key,
                       "summary_t", drivers::encoded(*summary), summary->config_sha256);
  add(std::move(out), now);
  return true;
}

bool Uplink::add(Outgoing outgoing, Instant now) {
  const std::string key = outgoing.message.header(header::kKey);
  if (window_.has(key) || unstored_keys_.contains(key)) return false;
  window_.add(std::move(outgoing), now.steady_us);
  return true;
}

void Uplink::send(Instant now) {
  if (!link_.is_connected()) return;
  for (const std::int64_t number : window_.due(now.steady_us)) {
    Message message = window_.message(number);
    message.reply = fmt::format("{}.{}", link_.inbox(), number);
    if (!settings_.secret.empty()) {
      std::string& key = message.headers[header::kKey];
      key = sealed_key(key, settings_.secret + again_, message.bytes);
    }
    if (link_.publish(message))
      sent_bytes_ += static_cast<std::int64_t>(message.size());
    else
      window_.not_taken(number, now.steady_us);
  }
}

void Uplink::finish(Instant now) {
  hear_link(now);
  store(now, true);
}

uplink_status_t Uplink::status(Instant now) const {
  uplink_status_t m{};
  m.time_us = now.host_us;
  m.started_us = begun_.host_us;
  m.building = settings_.fleet.building;
  m.version = FRAMEWATCH_VERSION;
  m.connected = link_.is_connected() ? 1 : 0;
  m.connections = link_.connections();
  m.acknowledged_us = acknowledged_us_;
  const auto live = static_cast<std::int64_t>(live_.size());
  m.events_waiting = std::max<std::int64_t>(
      waiting_.event_count - static_cast<std::int64_t>(unstored_events_.size()), live);
  m.summaries_waiting = std::max<std::int64_t>(
      waiting_.period_count - static_cast<std::int64_t>(unstored_summaries_.size()), 0);
  m.pieces_waiting = raw_.waiting();
  m.under_way = static_cast<std::int64_t>(window_.messages());
  m.acknowledged = acknowledged_;
  m.sent_again = window_.sent_again();
  m.refused = refused_;
  m.sent_bytes = sent_bytes_;
  m.commands_obeyed = desk_.obeyed();
  m.commands_refused = desk_.refused();
  m.link_trouble = m.connected != 0 ? "" : link_.trouble();
  m.refusal = refusal_;
  m.store_trouble = store_trouble_.empty() ? outbox_trouble_ : store_trouble_;
  const daemon::ProcessUsage usage = daemon::process_usage();
  m.resident_bytes = usage.resident_bytes;
  m.cpu_s = usage.cpu_s;
  return m;
}

}  // namespace framewatch::fleet
