// SPDX-License-Identifier: MIT
#include "daemon/monitor/service/service_manager.h"

#include <unistd.h>

#include <cstdlib>
#include <sstream>

#include <fmt/core.h>
#include <systemd/sd-bus.h>
#include <systemd/sd-daemon.h>

#include "daemon/base/clocks.h"
#include "daemon/base/log.h"
#include "daemon/base/printable.h"
#include "daemon/base/signals.h"
#include "drivers/files/input_file.h"
#include "drivers/files/text_output.h"

namespace framewatch::daemon {
namespace {

constexpr std::int64_t kFeedsPerTimeout = 4;

constexpr const char* kSystemd = "org.freedesktop.systemd1";
constexpr std::uint64_t kTimeout_us = 1'000'000;

struct Free {
  void operator()(sd_bus* bus) const { ::sd_bus_flush_close_unref(bus); }
  void operator()(char* text) const { std::free(text); }
};

class Unit {
 public:
  explicit Unit(const std::string& name) {
    sd_bus* bus = nullptr;
    if (::sd_bus_open_system(&bus) < 0) return;
    bus_.reset(bus);
    ::sd_bus_set_method_call_timeout(bus, kTimeout_us);
    char* path = nullptr;
    if (::sd_bus_path_encode("/org/freedesktop/systemd1/unit", name.c_str(), &path) >= 0)
      path_.reset(path);
  }
  bool reached() const { return bus_ && path_; }

  std::string text(const char* interface, const char* property) const {
    char* value = nullptr;
    if (::sd_bus_get_property_string(bus_.get(), kSystemd, path_.get(), interface, property,
                                     nullptr, &value) < 0)
      return {};
    const std::unique_ptr<char, Free> owned(value);
    return value;
  }
  std::uint32_t number(const char* interface, const char* property) const {
    std::uint32_t value = 0;
    if (::sd_bus_get_property_trivial(bus_.get(), kSystemd, path_.get(), interface, property,
                                      nullptr, 'u', &value) < 0)
      return 0;
    return value;
  }

 private:
  std::unique_ptr<sd_bus, Free> bus_;
  std::unique_ptr<char, Free> path_;
};

std::string times(std::int64_t n) {
  return n == 1 ? "once" : fmt::format("{} times", n);
}

constexpr unsigned kRetry_us = 500'000;

constexpr std::int64_t kStartCountBytes = 4096;

std::string file_of(const std::string& state_path) {
  return state_path + ".starts";
}

std::string store(const std::string& state_path, const StartCount& count, bool running) {
  return drivers::write_text_file(
      file_of(state_path), fmt::format("starts {}\nunclean_starts {}\nrunning {}\n", count.starts,
                                       count.unclean_starts, running ? 1 : 0));
}

}  // namespace

ServiceManager::ServiceManager() : listens_(std::getenv("NOTIFY_SOCKET") != nullptr) {
  std::uint64_t timeout_us = 0;
  if (::sd_watchdog_enabled(0, &timeout_us) > 0)
    feed_every_us_ = static_cast<std::int64_t>(timeout_us) / kFeedsPerTimeout;
}

void ServiceManager::ready() {
  ::sd_notify(0, "READY=1");
}

void ServiceManager::status(const std::string& line) {
  if (!listens_ || line == sent_) return;
  sent_ = line;
  ::sd_notify(0, ("STATUS=" + printable(line)).c_str());
}

void ServiceManager::alive(std::int64_t now_us) {
  if (feed_every_us_ == 0 || now_us < next_feed_us_) return;
  next_feed_us_ = now_us + feed_every_us_;
  ::sd_notify(0, "WATCHDOG=1");
}

void ServiceManager::reloading() {
  ::sd_notify(0, fmt::format("RELOADING=1\nMONOTONIC_USEC={}", steady_clock_us()).c_str());
}

void ServiceManager::stopping() {
  ::sd_notify(0, "STOPPING=1");
}

std::optional<UnitState> unit_state(const std::string& unit) {
  constexpr const char* kUnit = "org.freedesktop.systemd1.Unit";
  constexpr const char* kService = "org.freedesktop.systemd1.Service";
  const Unit found(unit);
  if (!found.reached() || found.text(kUnit, "LoadState") != "loaded") return std::nullopt;
  return UnitState{found.text(kUnit, "ActiveState"), found.text(kUnit, "SubState"),
                   found.text(kService, "Result"), found.number(kService, "NRestarts")};
}

std::string unit_text(const UnitState& s) {
  std::string out = fmt::format("{} ({})", s.active, s.sub);
  if (s.result != "success" && !s.result.empty()) out += ", the last result was " + s.result;
  if (s.restarts > 0)
    out += fmt::format(", restarted {} by systemd since somebody started it", times(s.restarts));
  return out;
}

std::string unit_oddity(const UnitState& s) {
  if (s.active == "failed" && s.result == "start-limit-hit")
    return "systemd has stopped restarting it after too many failures: read journalctl -u "
           "framewatch, "
           "then run systemctl reset-failed framewatch";
  if (s.active == "failed") return "the service has failed: " + s.result;
  if (s.sub == "auto-restart")
    return fmt::format(
        "it keeps failing: systemd has restarted it {}. Read journalctl -u framewatch",
        times(s.restarts));
  return {};
}

std::unique_ptr<drivers::LcmProvider> open_lcm_with_retry(const Config& config,
                                                          const std::string& url,
                                                          ServiceManager& manager,
                                                          std::string& error) {
  const std::string& where = url.empty() ? config.lcm.url : url;
  for (bool said = false;; said = true) {
    auto lcm = drivers::open_lcm(where, config.lcm.reception, error);
    const bool may_come = manager.listens() && where.starts_with("udpm://");
    if (lcm || !may_come || stop_requested()) return lcm;
    if (!said) {
      std::istringstream lines(error);
      for (std::string line; std::getline(lines, line);) log(LogLevel::warning, line);
      log(LogLevel::warning, "waiting for LCM, and trying again");
      manager.ready();
    }
    manager.status("waiting for LCM on " + where);
    manager.alive(steady_clock_us());
    ::usleep(kRetry_us);
  }
}

StartCount count_start(const std::string& state_path, std::string& problem) {
  StartCount count;
  std::int64_t running = 0;
  std::string unread;
  std::istringstream file(
      drivers::read_whole_file(file_of(state_path), kStartCountBytes, unread).value_or(""));
  std::string key;
  for (std::int64_t value = 0; file >> key >> value;) {
    if (key == "starts") count.starts = value;
    if (key == "unclean_starts") count.unclean_starts = value;
    if (key == "running") running = value;
  }
  ++count.starts;
  if (running != 0) ++count.unclean_starts;
  problem = store(state_path, count, true);
  return count;
}

std::string count_clean_stop(const std::string& state_path, const StartCount& count) {
  return store(state_path, count, false);
}

}  // namespace framewatch::daemon
