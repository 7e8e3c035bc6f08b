#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/monitor/service/health.h"
#include "daemon/monitor/service/service_manager.h"

namespace framewatch::daemon {

/// What `framewatch status --json` prints. odd: what is not well. Requires heard.service. now_us:
/// host clock.
std::string status_json(const Heard& heard, const Config& config,
                        const std::vector<std::string>& odd, const std::optional<UnitState>& unit,
                        std::int64_t now_us);

}  // namespace framewatch::daemon
