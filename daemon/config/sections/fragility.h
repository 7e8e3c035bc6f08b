// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string>

#include "daemon/config/keys/event_report_options.h"

namespace framewatch::daemon {

/// Returns HAZUS drift ratios at the threshold of slight, moderate, extensive and complete
/// structural damage. `type` includes the height class, if it has one: "C1L", "W1". Returns nullopt
/// if HAZUS has no such type at that design level. Source: FEMA, HAZUS-MH MR4 Technical Manual,
/// Tables 5.9a (high), b (moderate), c (low) and d (pre-code).
std::optional<std::array<double, estimator::kDamageStates>> hazus_limits(const std::string& type,
                                                                         DesignLevel level);

/// Appends the height class of HAZUS (Table 5.1) to a type: 1 to 3 stories low-rise, 4 to 7
/// mid-rise, more high-rise. URM is low-rise up to 2 and else mid-rise; RM1 is low-rise up to 3 and
/// else mid-rise. Returns types that include or lack heights unchanged.
std::string hazus_type_by_height(const std::string& type, int stories);

/// Returns the low-rise type if the type has heights and names none, else the type.
std::string hazus_type_of_story(const std::string& type);

}  // namespace framewatch::daemon
