// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <framewatch/can_status_t.hpp>
#include <framewatch/event_t.hpp>
#include <framewatch/gap_t.hpp>
#include <framewatch/model_fit_t.hpp>
#include <framewatch/session_status_t.hpp>
#include <framewatch/status_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include "daemon/config/config.h"
#include "daemon/monitor/events/event_messages.h"
#include "daemon/page/findings/answers.h"
#include "daemon/page/view/page_modes.h"

// Format messages as the JSON of the page's server-sent events (docs/dashboard.md), one line each.
// Values that are not finite become null.
namespace framewatch::daemon {

std::string estimate_json(const window_estimate_t& estimate, double min_snr);
std::string model_fit_json(const model_fit_t& fit);
std::string boxes_json(const window_estimate_t& estimate);
/// Formats the modes; shapes by degree of freedom (Structure::dof), their largest entry is 1.
std::string modes_json(const PageModes& modes);
std::string baseline_json(const std::vector<double>& baseline);
/// config_sha256: digest of the page's configuration, for "same_config".
std::string status_json(const status_t& status, const std::string& config_sha256);
std::string gap_json(const gap_t& gap);
std::string can_json(const can_status_t& status);
std::string session_status_json(const session_status_t& status);
/// Formats the four answers, every open finding and the drift ratios of the newest shake by story.
std::string answers_json(const Known& known, const Config& config);
/// Formats the reason why a daemon refused the command of the request `id`.
std::string refused_json(std::int64_t id, const std::string& problem);
/// by: who acknowledged the event and with which comment; empty where unknown.
std::string alarm_json(const event_t& event, bool acknowledged, const Acknowledgement& by);
/// Formats the building, its axes and parameters. rate_hz: rate of the rows of motion.
std::string building_json(const Config& config, double rate_hz);

}  // namespace framewatch::daemon
