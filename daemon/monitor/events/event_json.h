#pragma once

#include <string>

#include <framewatch/event_t.hpp>

namespace framewatch::daemon {

/// An event as one line of JSON (schema `framewatch.event/1`, docs/actions.md) for commands and
/// webhooks.
std::string event_json(const event_t& event, const std::string& building);

}  // namespace framewatch::daemon
