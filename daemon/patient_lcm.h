#pragma once

#include <memory>
#include <string>

#include <lcm/lcm-cpp.hpp>

#include "daemon/config.h"
#include "daemon/service_manager.h"

namespace framewatch::daemon {

/// LCM as configured, or on `url` unless that is empty. Under a service manager a machine whose
/// network is not there yet is waited for: it has just started. Null, with the reason, when LCM
/// cannot start, or somebody wants the program to stop.
std::unique_ptr<lcm::LCM> open_lcm_patiently(const Config& config, const std::string& url,
                                             ServiceManager& manager, std::string& error);

}  // namespace framewatch::daemon
