// SPDX-License-Identifier: MIT
#include "daemon/page/web/serve_command.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <optional>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/exit_code.h"
#include "daemon/base/file_digest.h"
#include "daemon/base/log.h"
#include "daemon/base/signals.h"
#include "daemon/config/sections/config_problems.h"
#include "daemon/monitor/service/service_manager.h"
#include "daemon/page/metrics/metrics.h"
#include "daemon/page/view/live_view.h"
#include "daemon/page/web/web_admission.h"
#include "daemon/page/web/web_server.h"
#include "daemon/page/web/web_socket.h"
#include "drivers/lcm/lcm_source.h"

namespace framewatch::daemon {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int kPoll_ms = 10;
constexpr std::chrono::milliseconds kFlush{50};

/// Returns the settings; prints the problems and returns nullopt when they are wrong.
std::optional<WebSettings> web_settings(const ServeArguments& a) {
  bool good = true;
  WebSettings settings{a.address, a.port, {}, a.hosts, a.files, a.sessions, {}, {}, {}};
  settings.connections.viewers = a.viewers;
  settings.connections.viewers_per_address = a.viewers_per_address;
  std::string error;
  if (!a.token_file.empty()) {
    const auto text = read_text_file(a.token_file, error);
    if (!text) {
      fmt::print(stderr, "framewatch serve: {}: {}\n", a.token_file, error);
      good = false;
    }
    settings.token = text ? text->substr(0, text->find_first_of("\r\n")) : "";
  }
  for (const std::string& problem : problems(settings)) {
    fmt::print(stderr, "framewatch serve: {}\n", problem);
    good = false;
  }
  if (!good) return std::nullopt;
  // Acknowledging needs a token even when the operator has not chosen one.
  if (settings.token.empty()) settings.token = random_token();
  return settings;
}

}  // namespace

int serve(const ServeArguments& a) {
  std::vector<ConfigProblem> problems_found;
  const std::optional<Config> config = load_config(a.config, problems_found);
  print_problems(problems_found);
  std::optional<WebSettings> settings = web_settings(a);
  if (!config || !settings) return kBadInput;
  if (config->event_report) settings->event_reports = config->event_report->directory;

  catch_stop_signals();
  ServiceManager manager;
  std::string error;
  const std::string& url = a.url.empty() ? config->lcm.url : a.url;
  const auto lcm = open_lcm_with_retry(*config, a.url, manager, error);
  if (!lcm && stop_requested()) return 0;
  if (!lcm) return refuse("serve", error);
  LiveView view(
      *config,
      [&](std::int64_t, const std::string& channel, const std::vector<std::uint8_t>& bytes) {
        lcm->publish(channel, bytes.data(), static_cast<unsigned>(bytes.size()));
      },
      [&](const std::string& service, const CommandPacket& command) {
        return give_command(*config, service, command);
      });
  Metrics metrics(*config);
  settings->metrics = [&metrics](const PageUse& use) {
    return metrics.text(steady_clock_us(), use);
  };
  std::vector<std::string> channels = view.channels();
  for (const std::string& channel : metrics.channels()) channels.push_back(channel);
  drivers::LcmSource source(*lcm, channels, config->lcm.queue_capacity,
                            [&](const drivers::LcmMessage& m) {
                              view.message(m.channel, m.data, m.size, m.sender, m.received_us);
                              metrics.message(m.channel, m.data, m.size, steady_clock_us());
                            });
  if (config->history) {
    std::vector<std::string> notes;
    view.restore(stored_history(*config, notes), host_clock_us());
    for (const std::string& note : notes) log(LogLevel::notice, "history:  " + note);
  }
  WebServer server(*settings, view);
  const int socket = listen_on(settings->address, settings->port, error);
  if (socket < 0 || !server.start(socket, error)) return refuse("serve", error);
  // The operator's token must not go into logs.
  fmt::print("{}\n", page_address(*settings, server.port(),
                                  a.token_file.empty() ? settings->token : std::string()));
  std::fflush(stdout);
  if (!a.quiet) log(LogLevel::info, fmt::format("{} on {}", config->pipeline.structure.name, url));

  manager.ready();
  RateLimitedLog failures(LogLevel::error);
  for (Clock::time_point next = Clock::now(); !stop_requested();) {
    if (!source.handle(kPoll_ms) && !stop_requested())
      failures(steady_clock_us(), "LCM failed to deliver");
    if (Clock::now() < next) continue;
    next = std::max(next + kFlush, Clock::now());
    view.flush();
    server.wake();
    manager.alive(steady_clock_us());
    manager.status(fmt::format("port {}, {} viewers", server.port(), server.viewers()));
  }
  manager.stopping();
  return 0;
}

}  // namespace framewatch::daemon
