#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "daemon/monitor/estimates/session_estimates.h"

namespace framewatch::daemon {

/// By window, whether the parameter's value there can be compared with the others: those of frames
/// that bend only where they were identified with about the bending stiffness (krx, kry) that was
/// known in the end, because the two go together. A first record finds the bending on its way.
std::vector<std::uint8_t> settled_windows(const SessionEstimates& session, std::size_t parameter);

/// The newest value, SI; NaN: there is none.
double last_value(const SessionEstimates& session, std::size_t parameter);

}  // namespace framewatch::daemon
