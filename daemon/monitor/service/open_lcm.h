// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "daemon/config/config.h"
#include "daemon/monitor/service/service_manager.h"
#include "drivers/lcm/lcm_provider.h"

namespace framewatch::daemon {

/// Opens LCM on `url`, or as configured if that is empty. Under a service manager it retries until
/// the network is up, because the machine may just have booted. Returns nullptr and sets `error`
/// when LCM cannot start or the program is stopped.
std::unique_ptr<drivers::LcmProvider> open_lcm_with_retry(const Config& config,
                                                          const std::string& url,
                                                          ServiceManager& manager,
                                                          std::string& error);

}  // namespace framewatch::daemon
