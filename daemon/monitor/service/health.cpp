// SPDX-License-Identifier: MIT
#include "daemon/monitor/service/health.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/usual_time.h"
#include "daemon/monitor/events/event_messages.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {
namespace {

constexpr double kSilent_s = 5;
constexpr double kBehind_s = 2;
constexpr double kLoss_ratio = 1e-3;
constexpr double kLate_ratio = 1e-2;
constexpr std::int64_t kLittleDisk_bytes = 1'000'000'000;
constexpr double kYoung_s = 600;
constexpr double kHubSilent_s = 3600;
constexpr int kCanActive = 0;

double seconds_between(std::int64_t from_us, std::int64_t to_us) {
  return 1e-6 * static_cast<double>(to_us - from_us);
}

void of_process(const service_t& s, const Config& config, std::int64_t now_us,
                std::vector<std::string>& out) {
  const double age_s = seconds_between(s.started_us, now_us);
  if (s.unclean_starts > 0 && age_s < kYoung_s)
    out.push_back(
        fmt::format("it started {} ago; {} of {} starts followed a crash: journalctl -u framewatch",
                    span_text(age_s), s.unclean_starts, s.starts));
  if (s.version != FRAMEWATCH_VERSION)
    out.push_back(fmt::format("it is version {}, this program is {}: systemctl restart framewatch",
                              s.version, FRAMEWATCH_VERSION));
  if (!s.reload_problem.empty())
    out.push_back("the reloaded configuration was refused: " + s.reload_problem);
  else if (s.config_sha256 != config.sha256)
    out.push_back(
        fmt::format("{} has changed since it was read: systemctl reload framewatch", config.path));
  if (!s.state_problem.empty())
    out.push_back("its state cannot be written, so a restart loses the window: " + s.state_problem);
  if (s.disk_free_bytes >= 0 && s.disk_free_bytes < kLittleDisk_bytes)
    out.push_back(fmt::format("{:.1f} GB are free on the disk of its state file",
                              1e-9 * static_cast<double>(s.disk_free_bytes)));
}

bool is_raised(const service_t& s, const std::string& kind, const std::string& place) {
  for (std::size_t i = 0; i < s.event_id.size(); ++i)
    if (s.event_kind[i] == kind && s.event_place[i] == place) return true;
  return false;
}

void of_samples(const Heard& heard, std::int64_t now_us, std::vector<std::string>& out) {
  const service_t& s = *heard.service;
  const double silent = silent_s(s, now_us);
  if (silent > kSilent_s) {
    out.push_back(s.received_us == 0
                      ? fmt::format("no samples since it started {} ago", span_text(silent))
                      : fmt::format("no samples for {}", span_text(silent)));
    return;
  }
  const auto moves = [&](std::size_t i) {
    return heard.first_service && i < heard.first_service->newest_us.size() &&
           s.newest_us[i] > heard.first_service->newest_us[i];
  };
  std::vector<std::int64_t> moving_us(s.newest_us.size(), 0);
  for (std::size_t i = 0; i < moving_us.size(); ++i)
    if (moves(i)) moving_us[i] = s.newest_us[i];
  const std::int64_t usual_moving_us = usual_time_us(moving_us, 0);
  const std::int64_t usual_us =
      usual_moving_us != 0 ? usual_moving_us : usual_time_us(s.newest_us, 0);
  for (std::size_t i = 0; i < s.name.size(); ++i) {
    const std::string& name = s.name[i];
    if (is_raised(s, "channel_silent", name) || is_raised(s, "channel_clock", name)) continue;
    const double behind_s = seconds_between(s.newest_us[i], usual_us);
    const std::string span = span_text(std::abs(behind_s));
    if (s.newest_us[i] == 0)
      out.push_back(fmt::format("{}: no samples yet", name));
    else if (moves(i) && std::abs(behind_s) > kBehind_s)
      out.push_back(fmt::format("{}: its clock is {} {} the others", name, span,
                                behind_s > 0 ? "behind" : "ahead of"));
    else if (behind_s > kBehind_s)
      out.push_back(fmt::format("{}: silent for {}", name, span));
  }
  if (!heard.first_status || heard.first_status->name.size() != heard.status->name.size()) return;
  for (std::size_t i = 0; i < heard.status->name.size(); ++i) {
    const auto lost = static_cast<double>(heard.status->lost[i] - heard.first_status->lost[i]);
    const auto received =
        static_cast<double>(heard.status->received[i] - heard.first_status->received[i]);
    if (lost > kLoss_ratio * (lost + received))
      out.push_back(fmt::format("{}: loses {:.1f} % of its samples", heard.status->name[i],
                                100 * lost / (lost + received)));
    if (const std::int64_t rejected = heard.status->rejected[i] - heard.first_status->rejected[i];
        rejected > 0)
      out.push_back(
          fmt::format("{}: {} of its samples were rejected", heard.status->name[i], rejected));
  }
  if (heard.status->queue_dropped > heard.first_status->queue_dropped)
    out.push_back("a full queue drops messages: this machine is too slow");
}

void of_punctuality(const Heard& heard, std::vector<std::string>& out) {
  if (!heard.first_service) return;
  const auto estimates =
      static_cast<double>(total(heard.service->latencies) - total(heard.first_service->latencies));
  const auto late =
      static_cast<double>(heard.service->deadline_missed - heard.first_service->deadline_missed);
  if (late > 0 && late > kLate_ratio * estimates)
    out.push_back(fmt::format("{:.0f} % of the estimates come late", 100 * late / estimates));
}

void of_watch(const watch_t& w, const Config& config, std::vector<std::string>& out) {
  if (config.watch && !config.watch->temperature_channel.empty() && std::isnan(w.temperature_degc))
    out.push_back(fmt::format("no temperature on {}", config.watch->temperature_channel));
}

/// Adds troubles of the history that are not raised as events.
void of_history(const history_status_t& s, const service_t& service,
                std::vector<std::string>& out) {
  if (!s.raw_trouble.empty() && !is_raised(service, "history", "raw"))
    out.push_back("raw samples are not stored: " + s.raw_trouble);
  if (!s.summary_trouble.empty() && !is_raised(service, "history", "summaries"))
    out.push_back("summaries are not stored: " + s.summary_trouble);
}

void of_uplink(const Heard& heard, const Config& config, std::int64_t now_us,
               std::vector<std::string>& out) {
  if (!config.fleet) return;
  if (!heard.uplink) {
    out.push_back("framewatch uplink does not report: systemctl status framewatch-uplink");
    return;
  }
  const uplink_status_t& s = *heard.uplink;
  if (!s.store_trouble.empty())
    out.push_back("the messages that wait for the hub cannot be read or written: " +
                  s.store_trouble);
  if (const double silent = seconds_between(std::max(s.acknowledged_us, s.started_us), now_us);
      silent > kHubSilent_s)
    out.push_back(fmt::format("the hub has acknowledged nothing for {}{}", span_text(silent),
                              s.link_trouble.empty() ? "" : ": " + s.link_trouble));
}

void of_reception(const Heard& heard, std::vector<std::string>& out) {
  if (!heard.first_reception) return;
  if (heard.reception->datagrams_overflowed > heard.first_reception->datagrams_overflowed)
    out.push_back("the kernel drops LCM datagrams: too many come at once for the receive buffer");
}

void of_actions(const action_status_t& s, std::vector<std::string>& out) {
  for (std::size_t i = 0; i < s.name.size(); ++i) {
    if (!s.trouble[i].empty() && s.name[i] == "report")
      out.push_back("the monthly report is not done: " + s.trouble[i]);
    else if (!s.trouble[i].empty())
      out.push_back(fmt::format("{} notifications of [actions] fail: {}", s.name[i], s.trouble[i]));
    else if (s.lost_us[i] > 0 && s.time_us - s.lost_us[i] < kDay_us)
      out.push_back(fmt::format("the {} of [actions] has lost {} events, the last one {} ago",
                                s.name[i], s.lost[i],
                                span_text(seconds_between(s.lost_us[i], s.time_us))));
  }
}

void of_can(const can_status_t& can, std::vector<std::string>& out) {
  constexpr const char* kStates[] = {"gone", "active", "full of errors", "error-passive",
                                     "bus-off"};
  for (std::size_t b = 0; b < can.interface.size(); ++b)
    if (can.state[b] != kCanActive)
      out.push_back(fmt::format("CAN bus {} is {}", can.interface[b],
                                kStates[std::clamp(can.state[b], -1, 3) + 1]));
}

void of_mqtt(const mqtt_status_t& s, std::vector<std::string>& out) {
  if (s.trouble.empty()) return;
  const std::string span = span_text(seconds_between(s.since_us, s.time_us));
  if (s.connected != 0)
    out.push_back(fmt::format("{}: {}. Its readings are missing: check the broker's access rules",
                              s.broker, s.trouble));
  else
    out.push_back(fmt::format("no connection to {} for {}: {}. Its readings are missing", s.broker,
                              span, s.trouble));
}

}  // namespace

std::vector<std::string> Heard::channels() const {
  return LatestMessages::channels(
      {DaemonMessage::service, DaemonMessage::status, DaemonMessage::estimate, DaemonMessage::gap,
       DaemonMessage::watch, DaemonMessage::weather, DaemonMessage::can, DaemonMessage::mqtt,
       DaemonMessage::history, DaemonMessage::actions, DaemonMessage::acknowledged,
       DaemonMessage::reception, DaemonMessage::uplink});
}

void Heard::message(const std::string& channel, const void* data, std::size_t size) {
  auto earlier_service = first_service ? first_service : service;
  auto earlier_status = first_status ? first_status : status;
  auto earlier_reception = first_reception ? first_reception : reception;
  const auto changed = update(channel, {static_cast<const std::uint8_t*>(data), size});
  if (changed == DaemonMessage::service) first_service = std::move(earlier_service);
  if (changed == DaemonMessage::status) first_status = std::move(earlier_status);
  if (changed == DaemonMessage::reception) first_reception = std::move(earlier_reception);
}

bool Heard::enough() const {
  if (!first_service) return false;
  return first_status.has_value() || silent_s(*service, service->time_us) > kSilent_s;
}

std::int64_t total(const std::vector<std::int64_t>& values) {
  return std::accumulate(values.begin(), values.end(), std::int64_t{0});
}

double silent_s(const service_t& service, std::int64_t now_us) {
  return seconds_between(service.received_us == 0 ? service.started_us : service.received_us,
                         now_us);
}

std::string span_text(double seconds) {
  const auto s = static_cast<std::int64_t>(std::max(0.0, seconds));
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {} s", s / 60, s % 60);
  if (s < 86400) return fmt::format("{} h {} min", s / 3600, s % 3600 / 60);
  return fmt::format("{} d {} h", s / 86400, s % 86400 / 3600);
}

std::optional<std::size_t> acknowledgement_of(const std::optional<acknowledged_t>& acknowledged,
                                              std::int64_t event_id) {
  if (!acknowledged) return std::nullopt;
  const auto at = std::ranges::find(acknowledged->id, event_id);
  if (at == acknowledged->id.end()) return std::nullopt;
  return static_cast<std::size_t>(at - acknowledged->id.begin());
}

event_t raised_event(const service_t& s, std::size_t at) {
  event_t e{};
  e.id = s.event_id[at];
  e.time_us = e.since_us = s.event_since_us[at];
  e.state = event_state::raised;
  e.severity = s.event_severity[at];
  e.kind = s.event_kind[at];
  e.place = s.event_place[at];
  e.value = e.std_error = estimator::kNaN;
  e.message = s.event_message[at];
  return e;
}

std::vector<std::string> oddities(const Heard& heard, const Config& config, std::int64_t now_us,
                                  const std::function<std::string(const event_t&)>& words) {
  std::vector<std::string> out;
  const service_t& s = *heard.service;
  for (std::size_t i = 0; i < s.event_id.size(); ++i)
    if (s.event_severity[i] >= severity::warning &&
        !acknowledgement_of(heard.acknowledged, s.event_id[i]))
      out.push_back(fmt::format("{} ({}, event {})", words(raised_event(s, i)), s.event_kind[i],
                                s.event_id[i]));
  of_samples(heard, now_us, out);
  of_punctuality(heard, out);
  if (heard.can) of_can(*heard.can, out);
  if (heard.mqtt) of_mqtt(*heard.mqtt, out);
  if (heard.watch) of_watch(*heard.watch, config, out);
  if (heard.history) of_history(*heard.history, s, out);
  if (heard.actions) of_actions(*heard.actions, out);
  of_uplink(heard, config, now_us, out);
  of_reception(heard, out);
  of_process(s, config, now_us, out);
  return out;
}

}  // namespace framewatch::daemon
