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

// Messages as the JSON that the page gets by server-sent events (docs/dashboard.md), one line each.
// Values that are not finite are null.
namespace framewatch::daemon {

std::string estimate_json(const window_estimate_t& estimate, double min_snr);
std::string model_fit_json(const model_fit_t& fit);
std::string boxes_json(const window_estimate_t& estimate);
std::string baseline_json(const std::vector<double>& baseline);
/// config_sha256: of the page, to say whether the estimator runs with the same one.
std::string status_json(const status_t& status, const std::string& config_sha256);
std::string gap_json(const gap_t& gap);
std::string can_json(const can_status_t& status);
std::string session_status_json(const session_status_t& status);
/// The four answers, every open finding, and the drift ratios of the newest shake by story.
std::string answers_json(const Known& known, const Config& config);
/// Why a command of the page was not obeyed. id: of the request.
std::string refused_json(std::int64_t id, const std::string& problem);
/// acknowledged: whether the event is; by whom and with which comment, where that is known.
std::string alarm_json(const event_t& event, bool acknowledged, const Acknowledgement& by);
/// The building, its axes and parameters. rate_hz: of the rows of motion.
std::string building_json(const Config& config, double rate_hz);

}  // namespace framewatch::daemon
