#pragma once

#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/tools/commands/layout_outlook.h"

namespace framewatch::daemon {

/// What a layout of sensors on some floors does not show, or hardly, what its channels contradict
/// each other in, and what follows from it. config: of groups of stories.
std::vector<std::string> layout_warnings(const Config& config, const LayoutOutlook& outlook);

}  // namespace framewatch::daemon
