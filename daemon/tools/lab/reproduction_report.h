#pragma once

#include <string>

#include "daemon/tools/lab/reproduction.h"

namespace framewatch::daemon {

/// Everything as one HTML page, the same bytes for the same results. only: as given to
/// reproduce_paper(); the commands in the page repeat it.
std::string reproduction_html(const Reproduction& all, const std::string& only);

/// docs/accuracy.md. Needs the whole reproduction (no --case); everything in it comes from seeded
/// motions, so it is the same with and without FRAMEWATCH_DATA.
std::string accuracy_markdown(const Reproduction& all);

}  // namespace framewatch::daemon
