#pragma once

#include <string>

#include "estimator/watch/recovery.h"

namespace framewatch::daemon {

/// Stands before recovery_words() in the message of an event.
inline const std::string kAfterStrongMotion = "; after strong motion: ";

/// What a recovery law says, to follow the name of the element: "lost 9 % at the earthquake, 6 %
/// after 1 hour, recovering: 4 % (+-1 %) expected after 1 day"; "..., lasting: full recovery is
/// excluded, at least 6 % stays".
std::string recovery_words(const estimator::RecoveryLaw& law);

}  // namespace framewatch::daemon
