#pragma once

#include <string>

#include "daemon/action_way.h"

namespace framewatch::daemon {

/// POSTs a JSON text to settings.webhook, once. A certificate that is not trusted, and a
/// redirection, are refusals. Trying again may help unless the server refuses the request itself
/// (400, 401, ...).
Told post_webhook(const ActionSettings& settings, const std::string& json,
                  const Abandoned& abandoned);

}  // namespace framewatch::daemon
