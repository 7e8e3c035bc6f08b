#include "daemon/service/open_lcm.h"

#include <unistd.h>

#include <lcm/lcm-cpp.hpp>

#include "daemon/base/clocks.h"
#include "daemon/base/log.h"
#include "daemon/base/stop_signal.h"
#include "drivers/lcm/lcm_source.h"

namespace framewatch::daemon {
namespace {

constexpr unsigned kRetry_us = 500'000;

}  // namespace

std::unique_ptr<lcm::LCM> open_lcm_with_retry(const Config& config, const std::string& url,
                                              ServiceManager& manager, std::string& error) {
  const std::string& where = url.empty() ? config.lcm.url : url;
  for (bool said = false;; said = true) {
    auto lcm = drivers::open_lcm(where, config.lcm.receive_buffer_bytes, error);
    const bool may_come = manager.listens() && where.starts_with("udpm://");
    if (lcm || !may_come || stop_requested()) return lcm;
    if (!said) {
      log(LogLevel::warning, error + "\nwaits for it");
      manager.ready();
    }
    manager.status("waits for LCM on " + where);
    manager.alive(steady_clock_us());
    ::usleep(kRetry_us);
  }
}

}  // namespace framewatch::daemon
