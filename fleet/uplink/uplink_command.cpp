// SPDX-License-Identifier: MIT
#include "fleet/uplink/uplink_command.h"

#include <poll.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <system_error>
#include <vector>

#include <fmt/core.h>

#include <framewatch/acknowledged_t.hpp>

#include "daemon/base/clocks.h"
#include "daemon/base/exit_code.h"
#include "daemon/base/file_digest.h"
#include "daemon/base/log.h"
#include "daemon/base/signals.h"
#include "daemon/config/config.h"
#include "daemon/config/sections/config_problems.h"
#include "daemon/monitor/service/command_client.h"
#include "daemon/monitor/service/service_manager.h"
#include "drivers/files/caught.h"
#include "drivers/files/encoded.h"
#include "drivers/lcm/lcm_source.h"
#include "drivers/lcm/message_check.h"
#include "fleet/link/nats_link.h"
#include "fleet/uplink/uplink.h"

namespace framewatch::fleet {
namespace {

using daemon::Config;

constexpr int kPoll_ms = 200;
constexpr int kWithoutLcm = 1;

/// Returns the path of systemd's copy of a file (LoadCredential=) if it exists, else `path`.
std::string credential(const std::string& path) {
  const char* directory = std::getenv("CREDENTIALS_DIRECTORY");
  if (directory == nullptr) return path;
  const auto copy = std::filesystem::path(directory) / std::filesystem::path(path).filename();
  std::error_code none;
  return std::filesystem::exists(copy, none) ? copy.string() : path;
}

/// Returns a secret that only this building knows.
std::string a_secret(const daemon::FleetSettings& fleet) {
  return daemon::sha256_of_file(credential(fleet.key));
}

/// Sends the request to the daemon, as `framewatch acknowledge` does.
std::string acknowledge(const Config& config, const acknowledge_t& request) {
  const daemon::CommandAnswer answer =
      daemon::give_command(config, "run", {"ACKNOWLEDGE", drivers::encoded(request)});
  if (!answer.problem.empty()) return answer.problem;
  const auto done = drivers::decoded<acknowledged_t>(answer.bytes);
  return done ? done->refused : "the daemon's answer is malformed: it may have another version";
}

Instant now() {
  return {daemon::steady_clock_us(), daemon::host_clock_us()};
}

std::string state_text(const uplink_status_t& s) {
  if (s.connected == 0) return "no connection: " + s.link_trouble;
  return fmt::format("{} events and {} summaries are waiting", s.events_waiting,
                     s.summaries_waiting);
}

/// Logs one line when the connection is made and when it is lost.
class ConnectionLog {
 public:
  void update(const uplink_status_t& s, bool quiet) {
    const bool connected = s.connected != 0;
    if (connected == connected_ && said_) return;
    if (connected && !quiet) daemon::log(daemon::LogLevel::info, "the hub is connected");
    if (!connected)
      daemon::log(daemon::LogLevel::warning,
                  "no hub: " + s.link_trouble + "; unsent data stays in the history");
    connected_ = connected;
    said_ = true;
  }

 private:
  bool connected_ = false, said_ = false;
};

void wait_for_news(int lcm, int link) {
  std::array<::pollfd, 2> files{{{lcm, POLLIN, 0}, {link, POLLIN, 0}}};
  (void)::poll(files.data(), files.size(), kPoll_ms);
}

int work(const Config& config, const UplinkArguments& a, NatsLink& link,
         daemon::ServiceManager& manager, drivers::LcmProvider& lcm) {
  const std::string& prefix = config.lcm.prefix;
  Uplink uplink(
      {*config.fleet, *config.history, config.path, a_secret(*config.fleet)}, link,
      [&](const acknowledge_t& request) { return acknowledge(config, request); },
      history_exporter(config.path), now());
  std::vector<std::string> channels;
  for (const std::string& channel : Uplink::channels()) channels.push_back(prefix + channel);
  drivers::LcmSource source(lcm, channels, config.lcm.queue_capacity,
                            [&](const drivers::LcmMessage& m) {
                              uplink.heard(std::string_view(m.channel).substr(prefix.size()),
                                           {static_cast<const std::uint8_t*>(m.data), m.size});
                            });
  manager.ready();
  daemon::RateLimitedLog failures(daemon::LogLevel::error);
  daemon::OnceASecond second;
  ConnectionLog connection;
  while (!daemon::stop_requested()) {
    wait_for_news(source.descriptor(), link.descriptor());
    const Instant at = now();
    const std::string thrown = drivers::caught([&] {
      if (!source.handle(0) && !daemon::stop_requested())
        failures(at.steady_us, "LCM failed to deliver");
      uplink.step(at);
      if (!second.due(at.host_us)) return;
      const uplink_status_t status = uplink.status(at);
      const std::vector<std::uint8_t> bytes = drivers::encoded(status);
      lcm.publish(prefix + "UPLINK", bytes.data(), static_cast<unsigned>(bytes.size()));
      manager.status(state_text(status));
      connection.update(status, a.quiet);
      manager.alive(at.steady_us);
    });
    if (!thrown.empty()) failures(at.steady_us, thrown);
  }
  manager.stopping();
  uplink.finish(now());
  return 0;
}

}  // namespace

int uplink_command(const UplinkArguments& a) {
  std::vector<daemon::ConfigProblem> problems;
  const std::optional<Config> config = daemon::load_config(a.config, problems);
  daemon::print_problems(problems);
  if (!config) return daemon::kBadInput;
  const auto stop = [](int status, const std::string& why) {
    fmt::print(stderr, "framewatch uplink: {}\n", why);
    return status;
  };
  if (!config->fleet)
    return stop(daemon::kBadInput, a.config + " has no section [fleet] (docs/fleet.md)");
  daemon::catch_stop_signals();
  daemon::ServiceManager manager;
  std::string error;
  const daemon::FleetSettings& fleet = *config->fleet;
  const auto link = NatsLink::open({fleet.hubs, fleet.building, credential(fleet.certificate),
                                    credential(fleet.key), credential(fleet.ca)},
                                   error);
  if (!link) return stop(daemon::kBadInput, error);
  const auto lcm = daemon::open_lcm_with_retry(*config, a.url, manager, error);
  if (!lcm && daemon::stop_requested()) return 0;
  if (!lcm) return stop(kWithoutLcm, error);
  return work(*config, a, *link, manager, *lcm);
}

}  // namespace framewatch::fleet
