#pragma once

#include <string>

#include "drivers/records/record.h"

namespace framewatch::daemon {

/// What `convert` without a configuration says of headers whose contents `out` has no place for;
/// empty when there are none. has_names: the columns of `out` have names.
std::string lost_headers(const drivers::Record& record, const std::string& out, bool has_names);

}  // namespace framewatch::daemon
