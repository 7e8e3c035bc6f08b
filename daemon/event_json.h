#pragma once

#include <string>

#include <framewatch/event_t.hpp>

namespace framewatch::daemon {

/// An event for other programs: `framewatch.event/1`, docs/actions.md. One line.
std::string event_json(const event_t& event, const std::string& building);

}  // namespace framewatch::daemon
