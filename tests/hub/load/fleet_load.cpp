// SPDX-License-Identifier: MIT
// fleet_load FOLDER CERTIFICATES COUNT HUB...: COUNT buildings with the real uplink code in one
// process, each with a separate connection, until SIGTERM. FOLDER/bN is the history of building N,
// CERTIFICATES/bN.pem its certificate. Prints a line a second: connected buildings, waiting
// messages, messages under way, acknowledged ones, bytes sent, seconds of processor.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <framewatch/history_status_t.hpp>
#include <framewatch/parameter_table_t.hpp>
#include <framewatch/service_t.hpp>
#include <framewatch/status_t.hpp>
#include <framewatch/uplink_status_t.hpp>
#include <framewatch/watch_t.hpp>

#include "daemon/base/clocks.h"
#include "daemon/base/process.h"
#include "daemon/base/signals.h"
#include "drivers/files/encoded.h"
#include "drivers/files/number_text.h"
#include "fleet/link/nats_link.h"
#include "fleet/uplink/uplink.h"

namespace framewatch::fleet {
namespace fleet_load {

constexpr int kParameters = 120, kChannels = 20;
constexpr auto kPause = std::chrono::milliseconds(20);
constexpr std::int64_t kService_us = 60'000'000;

Instant now() {
  return {daemon::steady_clock_us(), daemon::host_clock_us()};
}

/// Nobody requests raw samples here.
class NoExporter : public RawExporter {
 public:
  std::string begin(const RawRequest&, const std::string&) override { return "none"; }
  std::optional<std::string> ended() override { return "none"; }
};

const std::string kConfig(64, 'a');

std::vector<std::string> names(const char* first, int count) {
  std::vector<std::string> out;
  for (int i = 0; i < count; ++i) out.push_back(fmt::format("{}_{}_x{}", first, i / 4 + 1, i % 4));
  return out;
}

std::vector<std::uint8_t> service() {
  service_t m{};
  m.time_us = daemon::host_clock_us();
  m.config = "/etc/framewatch/building.toml";
  m.config_sha256 = kConfig;
  m.version = FRAMEWATCH_VERSION;
  m.buckets = 12;
  m.limit_s.assign(12, 0.1);
  m.steps.assign(12, m.time_us % 1'000'003);
  m.latencies.assign(12, m.time_us % 999'983);
  m.channels = kChannels;
  m.name = names("floor", kChannels);
  m.newest_us.assign(kChannels, m.time_us);
  return drivers::encoded(m);
}

std::vector<std::uint8_t> status() {
  status_t m{};
  m.config_sha256 = kConfig;
  m.channels = kChannels;
  m.name = names("floor", kChannels);
  for (auto* list : {&m.received, &m.lost, &m.late, &m.repaired, &m.rejected, &m.stuck, &m.clipped})
    list->assign(kChannels, daemon::host_clock_us() % 1'000'003);
  m.noise_mps2_per_rthz.assign(kChannels, 1e-6);
  return drivers::encoded(m);
}

std::vector<std::uint8_t> parameters() {
  parameter_table_t m{};
  m.config_sha256 = kConfig;
  m.parameters = kParameters;
  m.name = names("kx", kParameters);
  m.unit.assign(kParameters, "N/m");
  m.kind.assign(kParameters, 0);
  m.story.assign(kParameters, 1);
  m.design.assign(kParameters, 1e8);
  return drivers::encoded(m);
}

/// Returns values that do not compress, like measured ones.
std::vector<double> measured(int count) {
  static std::mt19937_64 chance(1);
  std::vector<double> out;
  for (int i = 0; i < count; ++i)
    out.push_back(std::uniform_real_distribution<double>(0.9e8, 1.1e8)(chance));
  return out;
}

std::vector<std::uint8_t> watch() {
  watch_t m{};
  m.parameters = kParameters;
  m.watched.assign(kParameters, 1);
  for (auto* list :
       {&m.baseline, &m.baseline_std_error, &m.baseline_degc, &m.quiet_baseline, &m.quiet_std_error,
        &m.per_degc, &m.per_degc_std_error, &m.per_log_amplitude, &m.per_log_amplitude_std_error})
    *list = measured(kParameters);
  return drivers::encoded(m);
}

std::vector<std::uint8_t> history() {
  history_status_t m{};
  m.directory = "/var/lib/framewatch/history";
  m.raw_samples = m.raw_bytes = m.stored_bytes = daemon::host_clock_us();
  return drivers::encoded(m);
}

struct Building {
  std::unique_ptr<NatsLink> link;
  std::unique_ptr<Uplink> uplink;
};

Building building(const std::string& folder, const std::string& certificates,
                  const std::string& name, const std::vector<std::string>& hubs) {
  std::string error;
  Building out;
  out.link =
      NatsLink::open({hubs, name, fmt::format("{}/{}.pem", certificates, name),
                      fmt::format("{}/{}.key", certificates, name), certificates + "/ca.pem"},
                     error);
  if (!out.link) {
    fmt::print(stderr, "fleet_load: {}: {}\n", name, error);
    std::exit(2);
  }
  UplinkSettings settings;
  settings.fleet.building = name;
  settings.fleet.hubs = hubs;
  settings.history.directory = fmt::format("{}/{}", folder, name);
  out.uplink = std::make_unique<Uplink>(
      settings, *out.link, [](const acknowledge_t&) { return std::string("no daemon"); },
      std::make_unique<NoExporter>(), now());
  out.uplink->heard("PARAMETERS", parameters());
  out.uplink->heard("WATCH", watch());
  out.uplink->heard("HISTORY", history());
  return out;
}

void report(const std::vector<Building>& all) {
  int connected = 0;
  std::int64_t wait = 0, under_way = 0, acknowledged = 0, bytes = 0;
  for (const Building& one : all) {
    const uplink_status_t s = one.uplink->status(now());
    connected += s.connected;
    wait += s.events_waiting + s.summaries_waiting;
    under_way += s.under_way;
    acknowledged += s.acknowledged;
    bytes += s.sent_bytes;
  }
  fmt::print("{} {} {} {} {} {:.2f}\n", connected, wait, under_way, acknowledged, bytes,
             daemon::process_usage().cpu_s);
  std::fflush(stdout);
}

int run(const std::string& folder, const std::string& certificates, std::int64_t count,
        const std::vector<std::string>& hubs) {
  daemon::catch_stop_signals();
  std::vector<Building> all;
  for (std::int64_t i = 0; i < count; ++i)
    all.push_back(building(folder, certificates, fmt::format("b{}", i), hubs));
  std::int64_t report_us = 0, service_us = 0;
  while (!daemon::stop_requested()) {
    const std::int64_t at_us = daemon::steady_clock_us();
    if (at_us >= service_us) {
      service_us = at_us + kService_us;
      for (Building& one : all) {
        one.uplink->heard("SERVICE", service());
        one.uplink->heard("STATUS", status());
      }
    }
    for (Building& one : all) one.uplink->step(now());
    if (at_us >= report_us) {
      report_us = at_us + daemon::kSecond_us;
      report(all);
    }
    std::this_thread::sleep_for(kPause);
  }
  for (Building& one : all) one.uplink->finish(now());
  return 0;
}

}  // namespace fleet_load
}  // namespace framewatch::fleet

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  const auto count = words.size() < 4 ? std::nullopt : framewatch::drivers::parse_integer(words[2]);
  if (!count || *count < 1) {
    fmt::print(stderr, "usage: fleet_load FOLDER CERTIFICATES COUNT HUB...\n");
    return 2;
  }
  return framewatch::fleet::fleet_load::run(words[0], words[1], *count,
                                            {words.begin() + 3, words.end()});
}
