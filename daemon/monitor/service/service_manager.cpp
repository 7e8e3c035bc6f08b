#include "daemon/monitor/service/service_manager.h"

#include <systemd/sd-daemon.h>

#include <cstdlib>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/printable.h"

namespace framewatch::daemon {
namespace {

constexpr std::int64_t kFeedsPerTimeout = 4;

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

}  // namespace framewatch::daemon
