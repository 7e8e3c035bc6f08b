#pragma once

#include <array>
#include <optional>
#include <string>

#include "daemon/config/keys/event_report_options.h"

namespace framewatch::daemon {

/// HAZUS' drift over story height at the threshold of slight, moderate, extensive and complete
/// structural damage. type: with its height, "C1L", or one that has none, "W1". Nullopt where
/// HAZUS has no such type of that design level. Source: FEMA, HAZUS-MH MR4 Technical Manual,
/// Tables 5.9a (high), b (moderate), c (low) and d (pre-code).
std::optional<std::array<double, estimator::kDamageStates>> hazus_limits(const std::string& type,
                                                                         DesignLevel level);

/// "C1" with the height that its number of stories has in HAZUS (Table 5.1): 1 to 3 low-rise, 4 to
/// 7 mid-rise, more high-rise; of URM 1 to 2 and more, of RM1 1 to 3 and more. A type without
/// heights, or with one, is itself.
std::string hazus_type_by_height(const std::string& type, int stories);

/// The type's low-rise limits where it has heights and names none; else itself.
std::string hazus_type_of_story(const std::string& type);

}  // namespace framewatch::daemon
