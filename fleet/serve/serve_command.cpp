// SPDX-License-Identifier: MIT
#include "fleet/serve/serve_command.h"

#include <poll.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/exit_code.h"
#include "daemon/base/log.h"
#include "daemon/base/signals.h"
#include "daemon/monitor/service/service_manager.h"
#include "daemon/page/web/web_socket.h"
#include "drivers/files/caught.h"
#include "fleet/link/nats_link.h"
#include "fleet/serve/commander.h"
#include "fleet/serve/fleet_pages.h"
#include "fleet/serve/fleet_server.h"

namespace framewatch::fleet {
namespace {

constexpr const char* kServe = "fleet serve";
constexpr std::chrono::milliseconds kStep{50};

/// The connection to the hub, if hubs are given.
struct Desk {
  std::unique_ptr<NatsLink> link;
  std::unique_ptr<Commander> commander;
};

std::string problem_of(const FleetServeArguments& a, const People& people) {
  const bool local = a.address == "127.0.0.1" || a.address == "::1";
  if (!local && people.all().empty())
    return a.address + ": other machines can reach this address: name the people with --people";
  return {};
}

void serve_until_told(const FleetServeArguments& a, FleetServer& server, Desk& desk) {
  daemon::ServiceManager manager;
  manager.ready();
  daemon::RateLimitedLog failures(daemon::LogLevel::error);
  std::string hub = "no hub yet";
  while (!daemon::stop_requested()) {
    if (desk.link) {
      ::pollfd file{desk.link->descriptor(), POLLIN, 0};
      (void)::poll(&file, 1, static_cast<int>(kStep.count()));
    } else {
      std::this_thread::sleep_for(kStep);
    }
    const std::int64_t now_us = daemon::steady_clock_us();
    const std::string thrown = drivers::caught([&] {
      server.sweep();
      if (desk.commander) desk.commander->step(now_us, daemon::host_clock_us());
      manager.alive(now_us);
    });
    if (!thrown.empty()) failures(now_us, thrown);
    if (!desk.link) continue;
    const std::string state = desk.link->is_connected() ? "" : "no hub: " + desk.link->trouble();
    if (std::exchange(hub, state) == state) continue;
    if (!state.empty() || !a.quiet)
      daemon::log(state.empty() ? daemon::LogLevel::info : daemon::LogLevel::warning,
                  state.empty() ? "the hub is connected" : state);
  }
  manager.stopping();
}

}  // namespace

int fleet_serve_command(const FleetServeArguments& a) {
  People people;
  if (!a.people.empty())
    if (const std::string problem = people.read(a.people); !problem.empty())
      return daemon::refuse(kServe, problem);
  if (const std::string problem = problem_of(a, people); !problem.empty())
    return daemon::refuse(kServe, problem);

  daemon::catch_stop_signals();
  std::string error;
  Desk desk;
  const std::filesystem::path folder = a.directory;
  if (!a.hubs.empty()) {
    desk.link = NatsLink::open({a.hubs, "page", (folder / "page.pem").string(),
                                (folder / "page.key").string(), (folder / "ca.pem").string()},
                               error);
    if (!desk.link) return daemon::refuse(kServe, error);
  }
  FleetPages::Give give;
  if (desk.link)
    give = [&desk](CommandOrder order) { return desk.commander->give(std::move(order)); };
  FleetPages pages(a.database, std::move(give));
  if (desk.link)
    desk.commander = std::make_unique<Commander>(
        *desk.link, [&pages](const CommandResult& result) { pages.note(result); });
  FleetServerSettings settings;
  settings.web.address = a.address;
  settings.web.port = a.port;
  settings.web.hosts = a.hosts;
  settings.web.files = a.files;
  settings.people = std::move(people);
  FleetServer server(settings, pages);
  const int socket = daemon::listen_on(a.address, a.port, error);
  if (socket < 0 || !server.start(socket, error)) return daemon::refuse(kServe, error);
  fmt::print("{}\n", daemon::page_address(settings.web, server.port(), ""));
  std::fflush(stdout);
  serve_until_told(a, server, desk);
  return 0;
}

}  // namespace framewatch::fleet
