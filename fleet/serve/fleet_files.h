// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>

#include "daemon/page/web/web_files.h"

namespace framewatch::fleet {

/// Returns the files of the page of many buildings by path.
const std::map<std::string, daemon::WebFile>& fleet_files();

}  // namespace framewatch::fleet
