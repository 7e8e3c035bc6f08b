#include "daemon/patient_lcm.h"

#include <unistd.h>

#include "daemon/clocks.h"
#include "daemon/log.h"
#include "daemon/stop_signal.h"
#include "drivers/lcm_source.h"

namespace framewatch::daemon {
namespace {

constexpr unsigned kRetry_us = 500'000;

}  // namespace

std::unique_ptr<lcm::LCM> open_lcm_patiently(const Config& config, const std::string& url,
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
