// SPDX-License-Identifier: MIT
#include "fleet/worker/worker_command.h"

#include <poll.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/base/clocks.h"
#include "daemon/base/exit_code.h"
#include "daemon/base/log.h"
#include "daemon/base/signals.h"
#include "daemon/monitor/service/service_manager.h"
#include "drivers/files/caught.h"
#include "drivers/files/number_text.h"
#include "fleet/link/nats_link.h"
#include "fleet/store/fleet_store.h"
#include "fleet/worker/worker.h"

namespace framewatch::fleet {
namespace {

using nlohmann::json;

constexpr const char* kFormat = "framewatch.inventory/1";
constexpr std::size_t kMaxDays = 400, kMaxPeriods = 16;
constexpr std::int64_t kLatest_us = INT64_MAX / 4;

std::optional<std::int64_t> count_of(const json& object, const char* name) {
  const auto found = object.find(name);
  if (found == object.end() || !found->is_number_integer()) return std::nullopt;
  return found->get<std::int64_t>();
}

std::optional<InventoryDay> day_of(const json& object) {
  if (!object.is_object()) return std::nullopt;
  const auto from_us = count_of(object, "from_us"), events = count_of(object, "events");
  const auto periods = object.find("periods");
  if (!from_us || *from_us < -kLatest_us || *from_us > kLatest_us || !events ||
      periods == object.end() || !periods->is_object() || periods->size() > kMaxPeriods)
    return std::nullopt;
  InventoryDay out{*from_us, {*events, {}}};
  for (const auto& [period, count] : periods->items()) {
    const auto period_s = drivers::parse_integer(period);
    if (!period_s || !count.is_number_integer()) return std::nullopt;
    out.counts.periods[*period_s] = count.get<std::int64_t>();
  }
  return out;
}

bool lacks(const DayCounts& stored, const DayCounts& wanted) {
  return stored.events < wanted.events ||
         std::any_of(wanted.periods.begin(), wanted.periods.end(), [&](const auto& one) {
           const auto found = stored.periods.find(one.first);
           return found == stored.periods.end() ? one.second > 0 : found->second < one.second;
         });
}

constexpr const char* kWorker = "fleet worker";
constexpr int kPoll_ms = 50;
constexpr std::int64_t kReport_us = 60'000'000;

WorkerTime now() {
  return {daemon::steady_clock_us(), daemon::host_clock_us()};
}

/// Logs changes at once and counts once a minute.
class WorkerLog {
 public:
  explicit WorkerLog(bool quiet) : quiet_(quiet) {}
  void look(const Worker::Counters& c, const NatsLink& link, std::int64_t steady_us) {
    const std::string hub = link.is_connected() ? "" : "no hub: " + link.trouble();
    if (std::exchange(hub_, hub) != hub) say(hub.empty() ? "the hub is connected" : hub);
    if (std::exchange(trouble_, c.trouble) != c.trouble)
      say(c.trouble.empty()
              ? "the database stores messages again"
              : "cannot write to the database: " + c.trouble + "; messages wait at the hub");
    if (quiet_ || steady_us < next_us_ || c.stored == said_) return;
    next_us_ = steady_us + kReport_us;
    said_ = c.stored;
    daemon::log(daemon::LogLevel::info,
                fmt::format("{} messages stored in {} batches, {} refused, {} unknown, {} "
                            "flooding, {} days requested again",
                            c.stored, c.batches, c.refused, c.unknown, c.flooding, c.resends));
  }

 private:
  static void say(const std::string& text) { daemon::log(daemon::LogLevel::warning, text); }
  bool quiet_;
  std::string hub_ = "no hub yet", trouble_;
  std::int64_t next_us_ = 0, said_ = 0;
};

void work(const WorkerArguments& a, NatsLink& link) {
  FleetStore store;
  Worker worker(
      link,
      [&](const FleetBatch& batch) -> StoreOutcome {
        std::string problem = store.open(a.database);
        if (!problem.empty()) return {std::move(problem), false};
        problem = store.add(batch);
        return {problem, !problem.empty() && store.is_of_values()};
      },
      [&](const std::string& building) { return missing_days(store, building); });
  daemon::ServiceManager manager;
  manager.ready();
  WorkerLog log(a.quiet);
  daemon::RateLimitedLog failures(daemon::LogLevel::error);
  while (!daemon::stop_requested()) {
    ::pollfd file{link.descriptor(), POLLIN, 0};
    (void)::poll(&file, 1, kPoll_ms);
    const WorkerTime at = now();
    const std::string thrown = drivers::caught([&] {
      worker.step(at);
      log.look(worker.counters(), link, at.steady_us);
      manager.alive(at.steady_us);
    });
    if (!thrown.empty()) failures(at.steady_us, thrown);
  }
  manager.stopping();
  worker.finish(now());
  (void)link.flush(2000);
}

}  // namespace

std::vector<InventoryDay> inventory_days(std::string_view text) {
  const json document = json::parse(text.begin(), text.end(), nullptr, false);
  if (!document.is_object() || document.value("format", json()) != kFormat) return {};
  const auto days = document.find("days");
  if (days == document.end() || !days->is_array() || days->size() > kMaxDays) return {};
  std::vector<InventoryDay> out;
  for (const json& one : *days) {
    auto day = day_of(one);
    if (!day) return {};
    out.push_back(std::move(*day));
  }
  std::sort(out.begin(), out.end(),
            [](const InventoryDay& a, const InventoryDay& b) { return a.from_us < b.from_us; });
  return out;
}

std::optional<std::vector<std::int64_t>> missing_days(FleetStore& store,
                                                      const std::string& building) {
  const auto text = store.newest_text(building, "inventory");
  if (!text) return std::nullopt;
  std::vector<InventoryDay> days = inventory_days(*text);
  if (!days.empty()) days.pop_back();
  std::reverse(days.begin(), days.end());
  std::vector<std::int64_t> out;
  for (const InventoryDay& day : days) {
    const auto stored = store.counts(building, day.from_us, day.from_us + daemon::kDay_us);
    if (!stored) return std::nullopt;
    if (lacks(*stored, day.counts)) out.push_back(day.from_us);
  }
  return out;
}

int worker_command(const WorkerArguments& a) {
  daemon::catch_stop_signals();
  const std::filesystem::path folder = a.directory;
  std::string error;
  const auto link = NatsLink::open({a.hubs, "worker", (folder / "worker.pem").string(),
                                    (folder / "worker.key").string(), (folder / "ca.pem").string()},
                                   error);
  if (!link) return daemon::refuse(kWorker, error);
  work(a, *link);
  return 0;
}

}  // namespace framewatch::fleet
