#pragma once

#include <memory>
#include <string>

#include "daemon/config/config.h"
#include "daemon/monitor/service/service_manager.h"
#include "drivers/lcm/lcm_provider.h"

namespace framewatch::daemon {

/// Opens LCM as configured, or on `url` unless that is empty. Under a service manager it retries
/// until the network is there, because the machine may have just started. Null, with the reason,
/// when LCM cannot start or the program is to stop.
std::unique_ptr<drivers::LcmProvider> open_lcm_with_retry(const Config& config,
                                                          const std::string& url,
                                                          ServiceManager& manager,
                                                          std::string& error);

}  // namespace framewatch::daemon
