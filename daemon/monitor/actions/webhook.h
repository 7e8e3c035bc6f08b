// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "daemon/monitor/actions/notifier.h"

namespace framewatch::daemon {

/// POSTs an event to the webhook of [actions] once, in its format. An untrusted certificate and a
/// redirection are failures. Sets `retry` unless the server refuses the request itself (400, 401,
/// ...); then `trouble` says what to mend.
DeliveryResult post_webhook(const ActionSettings& settings, const event_t& event,
                            const std::string& building, const Abandoned& abandoned);

}  // namespace framewatch::daemon
