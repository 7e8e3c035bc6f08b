#include "daemon/page/findings/status_json.h"

#include <numeric>

#include <nlohmann/json.hpp>

#include "daemon/base/file_digest.h"

namespace framewatch::daemon {
namespace {

std::int64_t sum_of(const std::vector<std::int64_t>& values) {
  return std::accumulate(values.begin(), values.end(), std::int64_t{0});
}

}  // namespace

std::string status_json(const Heard& h, const Config& config, const std::vector<std::string>& odd,
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
  if (h.status) {
    out["windows"] = h.status->windows;
    out["latency_s"] = h.status->latency_s;
    out["lost"] = sum_of(h.status->lost);
    out["rejected"] = sum_of(h.status->rejected);
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
  out["events"] = nlohmann::json::array();
  for (std::size_t i = 0; i < s.event_id.size(); ++i) {
    const auto at = acknowledgement_of(h, s.event_id[i]);
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

}  // namespace framewatch::daemon
