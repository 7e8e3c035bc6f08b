// SPDX-License-Identifier: MIT
#include "daemon/page/findings/status_command.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/base/clocks.h"
#include "daemon/base/exit_code.h"
#include "daemon/base/file_digest.h"
#include "daemon/base/numbers.h"
#include "daemon/base/printable.h"
#include "daemon/base/utc_time.h"
#include "daemon/config/config.h"
#include "daemon/config/sections/config_problems.h"
#include "daemon/config/sections/sections.h"
#include "daemon/monitor/history/disk_forecast.h"
#include "daemon/monitor/service/health.h"
#include "daemon/page/findings/finding.h"
#include "drivers/lcm/lcm_source.h"

namespace framewatch::daemon {
namespace {

nlohmann::json weather_json(const weather_status_t& w) {
  return {{"name", w.name},       {"value", w.value},       {"value_us", w.value_us},
          {"time_us", w.time_us}, {"accepted", w.accepted}, {"rejected", w.rejected}};
}

constexpr double kDiskSoon_days = 14;  // from here on, the status is bad

/// When the disk of the history is full.
struct DiskOutlook {
  std::optional<double> days;  ///< empty: not within 10 years
  std::string sentence;
};

/// Returns nullopt without a history, or if this user cannot read it.
std::optional<DiskOutlook> disk_outlook(const Config& config, std::int64_t now_us) {
  if (!config.history) return std::nullopt;
  const std::optional<HistoryGrowth> growth = history_growth(*config.history, now_us);
  if (!growth) return std::nullopt;
  const std::optional<double> days = days_until_full(*config.history, *growth);
  return DiskOutlook{days, disk_sentence(days, now_us)};
}

nlohmann::json mqtt_json(const mqtt_status_t& s) {
  return {{"broker", s.broker},         {"connected", s.connected != 0},
          {"trouble", s.trouble},       {"messages", s.messages},
          {"dropped", s.dropped},       {"retained", s.retained},
          {"unreadable", s.unreadable}, {"unread", s.unread}};
}

/// Returns the output of `framewatch status --json`. odd: the problems found. Requires
/// heard.service. now_us: host clock.
std::string status_json(const Heard& h, const Config& config,
                        const std::optional<DiskOutlook>& disk, const std::vector<std::string>& odd,
                        const std::optional<UnitState>& unit, std::int64_t now_us) {
  const service_t& s = *h.service;
  nlohmann::json out{{"well", odd.empty()},
                     {"odd", odd},
                     {"version", s.version},
                     {"config", s.config},
                     {"config_sha256", s.config_sha256},
                     {"config_on_disk_sha256", sha256_of_file(config.path)},
                     {"started_us", s.started_us},
                     {"starts", s.starts},
                     {"unclean_starts", s.unclean_starts},
                     {"resumed", s.resumed != 0},
                     {"silent_s", silent_s(s, now_us)},
                     {"state_written_us", s.state_written_us},
                     {"disk_free_bytes", s.disk_free_bytes},
                     {"resident_bytes", s.resident_bytes},
                     {"reloads", s.reloads},
                     {"reloads_refused", s.reloads_refused}};
  if (disk) out["disk_full_in_days"] = disk->days ? nlohmann::json(*disk->days) : nullptr;
  if (h.status) {
    out["windows"] = h.status->windows;
    out["latency_s"] = h.status->latency_s;
    out["lost"] = total(h.status->lost);
    out["rejected"] = total(h.status->rejected);
  }
  if (h.reception)
    out["dropped"] = {{"elsewhere", h.reception->datagrams_elsewhere},
                      {"malformed", h.reception->datagrams_malformed},
                      {"overflowed", h.reception->datagrams_overflowed},
                      {"unfinished", h.reception->messages_unfinished},
                      {"queue_full", h.reception->messages_dropped}};
  if (h.watch) {
    const watch_t& w = *h.watch;
    out["watch"] = {{"baseline", w.baseline},
                    {"baseline_std_error", w.baseline_std_error},
                    {"baseline_degc", w.baseline_degc},
                    {"quiet_learned_ratio", w.quiet_learned_ratio},
                    {"quiet_baseline", w.quiet_baseline},
                    {"quiet_std_error", w.quiet_std_error},
                    {"per_degc", w.per_degc},
                    {"per_degc_std_error", w.per_degc_std_error},
                    {"per_log_amplitude", w.per_log_amplitude},
                    {"per_log_amplitude_std_error", w.per_log_amplitude_std_error},
                    {"temperature_degc", w.temperature_degc}};
  }
  if (h.weather) out["weather"] = weather_json(*h.weather);
  if (h.uplink)
    out["hub"] = {{"building", h.uplink->building},
                  {"connected", h.uplink->connected != 0},
                  {"acknowledged_us", h.uplink->acknowledged_us},
                  {"events_waiting", h.uplink->events_waiting},
                  {"summaries_waiting", h.uplink->summaries_waiting},
                  {"pieces_waiting", h.uplink->pieces_waiting},
                  {"refused", h.uplink->refused}};
  if (unit)
    out["systemd"] = {{"active", unit->active},
                      {"sub", unit->sub},
                      {"result", unit->result},
                      {"restarts", unit->restarts}};
  if (h.mqtt) out["mqtt"] = mqtt_json(*h.mqtt);
  out["events"] = nlohmann::json::array();
  for (std::size_t i = 0; i < s.event_id.size(); ++i) {
    const auto at = acknowledgement_of(h.acknowledged, s.event_id[i]);
    nlohmann::json known;
    if (at)
      known = {{"time_us", h.acknowledged->since_us[*at]},
               {"who", h.acknowledged->who[*at]},
               {"comment", h.acknowledged->comment[*at]}};
    out["events"].push_back({{"id", s.event_id[i]},
                             {"since_us", s.event_since_us[i]},
                             {"severity", s.event_severity[i]},
                             {"kind", s.event_kind[i]},
                             {"place", s.event_place[i]},
                             {"message", s.event_message[i]},
                             {"acknowledged", known}});
  }
  return out.dump(2, ' ', true, nlohmann::json::error_handler_t::replace);
}

constexpr int kNotWell = 1, kUnreachable = 2;
constexpr std::int64_t kListen_us = 4'000'000;
constexpr int kPoll_ms = 100;

/// Returns the increase per second of sensor time; nullopt unless two reports came.
std::optional<double> rate(const Heard& h, std::int64_t first, std::int64_t last) {
  const double seconds =
      h.first_status ? 1e-6 * static_cast<double>(h.status->time_us - h.first_status->time_us) : 0;
  if (!(seconds > 0)) return std::nullopt;
  return static_cast<double>(last - first) / seconds;
}

void line(const char* what, const std::string& text) {
  fmt::print("  {:<11} {}\n", what, printable(text));
}

void print_process(const service_t& s, std::int64_t now_us) {
  std::string running =
      fmt::format("for {}, since {}", span_text(1e-6 * static_cast<double>(now_us - s.started_us)),
                  utc_and_local_text(s.started_us));
  if (s.starts > 0)
    running += fmt::format("; {}; {} starts, {} after a crash",
                           s.resumed != 0 ? "resumed from its state file" : "started afresh",
                           s.starts, s.unclean_starts);
  line("running", running);
  if (s.state_written_us > 0)
    line("state", fmt::format("written {} ago, {:.1f} GB of disk free",
                              span_text(1e-6 * static_cast<double>(now_us - s.state_written_us)),
                              1e-9 * static_cast<double>(s.disk_free_bytes)));
  line("machine", fmt::format("{:.0f} MB of memory, {:.1f} % of a core since the start",
                              1e-6 * static_cast<double>(s.resident_bytes),
                              100e6 * s.cpu_s / static_cast<double>(now_us - s.started_us)));
}

/// Prints the running configuration and whether the file at `path` still has its content.
void print_config(const service_t& s, const std::string& path) {
  std::string text = fmt::format("{}, sha256 {:.12}", s.config, s.config_sha256);
  if (s.reloads > 0) text += fmt::format(", reloaded {} times", s.reloads);
  const std::string now = sha256_of_file(path);
  line("config", text + (now == s.config_sha256 ? ", as it is on the disk"
                         : now.empty()          ? fmt::format("; {} cannot be read", path)
                                                : fmt::format("; {} is another one now", path)));
}

void print_samples(const Heard& h) {
  if (!h.status) return;
  std::string samples = fmt::format("{} channels", h.status->name.size());
  if (h.first_status) {
    const auto per_s = rate(h, total(h.first_status->received), total(h.status->received));
    if (per_s) samples += fmt::format(", {:.0f} a second", *per_s);
  }
  const std::int64_t lost = total(h.status->lost);
  samples +=
      fmt::format("; {} lost of {} since the state began", lost, total(h.status->received) + lost);
  if (const std::int64_t rejected = total(h.status->rejected); rejected > 0)
    samples += fmt::format(", {} rejected", rejected);
  line("samples", samples);
}

void print_estimates(const Heard& h) {
  if (!h.status) return;
  std::string text = fmt::format("{} windows", h.status->windows);
  if (h.first_status)
    if (const auto per_s = rate(h, h.first_status->windows, h.status->windows))
      text += fmt::format(", {:.0f} a second, {:.1f} ms after their sample", *per_s,
                          1e3 * h.status->latency_s);
  if (h.estimate)
    text += fmt::format("; {} of {} values now",
                        std::count(h.estimate->reason.begin(), h.estimate->reason.end(), 0),
                        h.estimate->reason.size());
  line("estimates", text);
  if (h.gap)
    line("gap", fmt::format("simulation and measurement differ by {:.1f} %, noise alone {:.1f} %",
                            100 * h.gap->overall_nrmse, 100 * h.gap->noise_floor));
}

/// Prints the baseline that changes are measured against.
void print_watch(const Heard& h) {
  if (!h.watch) return;
  const watch_t& w = *h.watch;
  const auto known = [&](const std::vector<double>& baseline) {
    int count = 0;
    for (std::size_t p = 0; p < w.watched.size(); ++p)
      count += w.watched[p] != 0 && std::isfinite(baseline[p]) ? 1 : 0;
    return count;
  };
  std::string text = known(w.baseline) + known(w.quiet_baseline) == 0
                         ? std::string("no baseline yet, changes are not detected")
                         : fmt::format("{} of {} stiffnesses have a baseline", known(w.baseline),
                                       std::count(w.watched.begin(), w.watched.end(), 1));
  if (w.long_window_s > 0)
    text += w.quiet_learned_ratio < 1
                ? fmt::format(", the baseline of weak motion is {:.0f} % learned",
                              100 * w.quiet_learned_ratio)
                : fmt::format(", {} a baseline of weak motion", known(w.quiet_baseline));
  if (const double slope = median(w.per_degc); std::isfinite(slope))
    text += fmt::format("; {:+.2f} % per degC (median)", 100 * slope);
  if (std::isfinite(w.temperature_degc)) text += fmt::format("; {:.1f} degC", w.temperature_degc);
  line("watch", text);
}

/// Prints the newest value of every covariate and its age.
void print_weather(const Heard& h) {
  if (!h.weather) return;
  const weather_status_t& w = *h.weather;
  for (std::size_t c = 0; c < w.name.size(); ++c) {
    const double age_min = 1e-6 * static_cast<double>(w.time_us - w.value_us[c]) / 60;
    std::string text = w.value_us[c] == 0 ? "no reading yet"
                       : age_min < 120
                           ? fmt::format("{:.5g}, {:.0f} min old", w.value[c], age_min)
                           : fmt::format("{:.5g}, {:.1f} h old", w.value[c], age_min / 60);
    if (w.rejected[c] > 0) text += fmt::format("; {} readings rejected", w.rejected[c]);
    line("weather", fmt::format("{}: {}", w.name[c], text));
  }
}

void print_history(const Heard& h, const std::optional<DiskOutlook>& disk) {
  if (!h.history) return;
  std::string text = fmt::format("{:.1f} GB in {}, {} samples lost to the disk",
                                 1e-9 * static_cast<double>(h.history->stored_bytes),
                                 h.history->directory, h.history->raw_dropped);
  if (h.history->disk_free_bytes >= 0)
    text += fmt::format(", {:.1f} GB free", 1e-9 * static_cast<double>(h.history->disk_free_bytes));
  if (disk) text += "; " + disk->sentence;
  line("history", text);
}

void print_actions(const Heard& h) {
  if (!h.actions) return;
  std::string text;
  for (std::size_t i = 0; i < h.actions->name.size(); ++i)
    text += fmt::format("{}{}: {} events sent, {} waiting, {} lost", i == 0 ? "" : "; ",
                        h.actions->name[i], h.actions->told[i], h.actions->waiting[i],
                        h.actions->lost[i]);
  line("actions", text);
}

/// Prints the messages that the LCM receiver dropped, if any.
void print_reception(const Heard& h) {
  if (!h.reception) return;
  const reception_t& r = *h.reception;
  std::vector<std::string> dropped;
  for (const auto& [count, what] :
       {std::pair{r.datagrams_elsewhere, "datagrams over other interfaces"},
        std::pair{r.datagrams_malformed, "datagrams that are not LCM"},
        std::pair{r.datagrams_overflowed, "datagrams in a full receive buffer"},
        std::pair{r.messages_unfinished, "unfinished messages"},
        std::pair{r.messages_dropped, "messages in a full queue"}})
    if (count > 0) dropped.push_back(fmt::format("{} {}", count, what));
  if (!dropped.empty()) line("dropped", fmt::format("{}", fmt::join(dropped, ", ")));
}

void print_known(const Heard& h, const Config& config, std::int64_t now_us) {
  const service_t& s = *h.service;
  for (std::size_t i = 0; i < s.event_id.size(); ++i) {
    const auto at = acknowledgement_of(h.acknowledged, s.event_id[i]);
    if (!at) continue;
    const acknowledged_t& a = *h.acknowledged;
    const std::string comment = a.comment[*at].empty() ? "" : ": " + a.comment[*at];
    line("known",
         fmt::format("{} ({}, event {}, acknowledged {} ago by {}{})",
                     finding_of(raised_event(s, i), config).text, s.event_kind[i], s.event_id[i],
                     span_text(1e-6 * static_cast<double>(now_us - a.since_us[*at])), a.who[*at],
                     comment));
  }
}

void print_hub(const Heard& h, std::int64_t now_us) {
  if (!h.uplink) return;
  const uplink_status_t& s = *h.uplink;
  const std::int64_t waiting = s.events_waiting + s.summaries_waiting + s.pieces_waiting;
  const std::string newest =
      s.acknowledged_us == 0
          ? "nothing acknowledged yet"
          : fmt::format("newest acknowledged {} ago",
                        span_text(1e-6 * static_cast<double>(now_us - s.acknowledged_us)));
  line("hub", fmt::format("{} waiting, {}{}", waiting, newest,
                          s.connected != 0 ? "" : ", no connection: " + s.link_trouble));
}

void print_can(const Heard& h) {
  if (!h.can) return;
  for (std::size_t b = 0; b < h.can->interface.size(); ++b)
    line("can", h.can->state[b] < 0
                    ? h.can->interface[b] + ": missing"
                    : fmt::format("{}: {:.0f} frames a second, {:.0f} % load", h.can->interface[b],
                                  h.can->frames_hz[b], 100 * h.can->load[b]));
}

void print_mqtt(const Heard& h) {
  if (!h.mqtt) return;
  const mqtt_status_t& s = *h.mqtt;
  std::string text = fmt::format("{}: {}, {} messages", s.broker,
                                 s.connected != 0    ? "connected"
                                 : s.trouble.empty() ? "connecting"
                                                     : "no connection",
                                 s.messages);
  if (s.dropped > 0) text += fmt::format(", {} dropped by a full queue", s.dropped);
  if (s.retained > 0) text += fmt::format(", {} retained without a time, ignored", s.retained);
  if (s.unreadable > 0) text += fmt::format(", {} unreadable: {}", s.unreadable, s.unread);
  line("mqtt", text);
}

void print_text(const Heard& h, const Config& config, const std::optional<DiskOutlook>& disk,
                const std::vector<std::string>& odd, const std::optional<UnitState>& unit,
                std::int64_t now_us) {
  const std::string& name = config.pipeline.structure.name;
  fmt::print("{}: {} (framewatch {})\n", printable(name.empty() ? h.service->config : name),
             odd.empty() ? toned(Tone::good, "well", stdout) : toned(Tone::bad, "not well", stdout),
             printable(h.service->version));
  print_process(*h.service, now_us);
  if (unit) line("systemd", unit_text(*unit));
  print_config(*h.service, config.path);
  print_samples(h);
  print_reception(h);
  print_estimates(h);
  print_watch(h);
  print_weather(h);
  print_can(h);
  print_mqtt(h);
  print_history(h, disk);
  print_actions(h);
  print_hub(h, now_us);
  print_known(h, config, now_us);
  for (const std::string& sentence : odd) line("odd", sentence);
}

/// Returns a configuration with only the [lcm] section of a file that has errors.
Config only_lcm(const std::string& path) {
  Config out;
  out.path = path;
  std::string error;
  const std::optional<std::string> text = read_text_file(path, error);
  std::vector<TextProblem> problems;
  if (!text) return out;
  if (const std::optional<TomlValue> document = parse_toml(*text, problems))
    out.lcm = read_lcm(*document, problems);
  return out;
}

}  // namespace

int status_command(const StatusArguments& a) {
  std::vector<ConfigProblem> problems;
  std::optional<Config> config = load_config(a.config, problems);
  const bool wrong = !config;
  if (wrong) config = only_lcm(a.config);
  const auto unit = a.config == kInstalledConfig ? unit_state("framewatch.service") : std::nullopt;
  const std::string& url = a.url.empty() ? config->lcm.url : a.url;
  std::string error;
  const auto lcm = drivers::open_lcm(url, config->lcm.reception, error);
  if (!lcm) return refuse("status", error);
  Heard heard(*config);
  drivers::LcmSource source(
      *lcm, heard.channels(), config->lcm.queue_capacity,
      [&](const drivers::LcmMessage& m) { heard.message(m.channel, m.data, m.size); });
  for (const std::int64_t end_us = steady_clock_us() + kListen_us;
       !heard.enough() && steady_clock_us() < end_us;)
    if (!source.handle(kPoll_ms)) break;
  if (!heard.service) {
    print_problems(problems);
    if (unit) fmt::print(stderr, "framewatch.service: {}\n", unit_text(*unit));
    fmt::print(stderr,
               "framewatch status: nothing is heard from framewatch run on {} with prefix {}: run "
               "systemctl status framewatch\n",
               url, config->lcm.prefix);
    return kUnreachable;
  }
  const std::int64_t now_us = host_clock_us();
  if (wrong) config->sha256 = heard.service->config_sha256;  // reports the wrong file only once
  const auto words = [&](const event_t& e) { return finding_of(e, *config).text; };
  std::vector<std::string> odd = oddities(heard, *config, now_us, words);
  if (wrong)
    odd.push_back(
        fmt::format("its configuration file is wrong now: it keeps the previous configuration but "
                    "would not start again: {}: {}",
                    problems.front().where, problems.front().message));
  const std::optional<DiskOutlook> disk = disk_outlook(*config, now_us);
  if (disk && disk->days && *disk->days < kDiskSoon_days)
    odd.push_back(disk->sentence + ": free it, or lower history.keep_gb");
  if (const std::string why = unit ? unit_oddity(*unit) : ""; !why.empty()) odd.push_back(why);
  if (a.json)
    fmt::print("{}\n", status_json(heard, *config, disk, odd, unit, now_us));
  else
    print_text(heard, *config, disk, odd, unit, now_us);
  return odd.empty() ? 0 : kNotWell;
}

}  // namespace framewatch::daemon
