// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <framewatch/event_t.hpp>

#include "daemon/config/keys/action_options.h"

namespace framewatch::daemon {

/// Returns true if an event, such as strong motion, is over when it is published: it will not
/// change and has no end.
bool is_momentary(const event_t& event);

/// Returns "alarm raised", "warning changed" or "alarm cleared"; only the severity for a momentary
/// event.
std::string state_words(const event_t& event);

/// Returns the JSON that a webhook of this format gets about an event. `topic` is that of ntfy,
/// `key` the integration key of PagerDuty. PagerDuty opens an incident when an event is raised and
/// resolves it when the event is cleared; a momentary event opens one that a person resolves.
std::string webhook_body(WebhookFormat format, const event_t& event, const std::string& building,
                         const std::string& topic, const std::string& key);

}  // namespace framewatch::daemon
