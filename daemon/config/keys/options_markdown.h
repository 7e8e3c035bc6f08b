#pragma once

#include <string>

namespace framewatch::daemon {

/// docs/configuration.md, made from the option table.
std::string options_markdown();

}  // namespace framewatch::daemon
