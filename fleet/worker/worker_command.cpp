#include "fleet/worker/worker_command.h"

#include <poll.h>

#include <filesystem>
#include <memory>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/exit_code.h"
#include "daemon/base/log.h"
#include "daemon/base/signals.h"
#include "daemon/monitor/service/service_manager.h"
#include "drivers/files/caught.h"
#include "fleet/link/nats_link.h"
#include "fleet/store/fleet_store.h"
#include "fleet/worker/missing_days.h"
#include "fleet/worker/worker.h"

namespace framewatch::fleet {
namespace {

constexpr const char* kWorker = "fleet worker";
constexpr int kPoll_ms = 50;
constexpr std::int64_t kReport_us = 60'000'000;

WorkerTime now() {
  return {daemon::steady_clock_us(), daemon::host_clock_us()};
}

/// What changes is said at once, counts once a minute.
class WorkerLog {
 public:
  explicit WorkerLog(bool quiet) : quiet_(quiet) {}
  void look(const Worker::Counters& c, const NatsLink& link, std::int64_t steady_us) {
    const std::string hub = link.is_connected() ? "" : "no hub: " + link.trouble();
    if (std::exchange(hub_, hub) != hub) say(hub.empty() ? "the hub is connected" : hub);
    if (std::exchange(trouble_, c.trouble) != c.trouble)
      say(c.trouble.empty() ? "the database takes everything again"
                            : "the database: " + c.trouble + "; what comes waits at the hub");
    if (quiet_ || steady_us < next_us_ || c.stored == said_) return;
    next_us_ = steady_us + kReport_us;
    said_ = c.stored;
    daemon::log(
        daemon::LogLevel::info,
        fmt::format(
            "{} messages stored in {} batches, {} refused, {} unknown, {} flooding, {} days "
            "asked for again",
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
