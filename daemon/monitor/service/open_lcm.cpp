// SPDX-License-Identifier: MIT
#include "daemon/monitor/service/open_lcm.h"

#include <unistd.h>

#include <sstream>
#include <string>

#include "daemon/base/clocks.h"
#include "daemon/base/log.h"
#include "daemon/base/signals.h"
#include "drivers/lcm/lcm_provider.h"

namespace framewatch::daemon {
namespace {

constexpr unsigned kRetry_us = 500'000;

}  // namespace

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

}  // namespace framewatch::daemon
