#pragma once

#include <string>

#include "daemon/monitor/actions/notifier.h"

namespace framewatch::daemon {

/// POSTs a JSON text to settings.webhook, once. An untrusted certificate or a redirection is a
/// failure. `retry` is set unless the server refuses the request itself (400, 401, ...).
DeliveryResult post_webhook(const ActionSettings& settings, const std::string& json,
                            const Abandoned& abandoned);

}  // namespace framewatch::daemon
