#pragma once

#include <framewatch/event_t.hpp>

#include "daemon/config/config.h"
#include "estimator/gap/gap.h"
#include "estimator/watch/recovery.h"
#include "estimator/watch/watch.h"

namespace framewatch::daemon {

/// News of a parameter's alarm as an event of kind "stiffness_change"; value and std_error in %,
/// NaN while the record has no number. Of what every stiffness has in common its place is
/// kWholeBuilding.
event_t stiffness_event(const estimator::Alarm& alarm, const estimator::ParameterTable& table);

/// A raised event of a stiffness with what its recovery law says, unless it is cleared or nothing
/// is known yet within Recovery::kRenew_s of the strong motion.
event_t recovering(event_t event, const estimator::RecoveryLaw& law);
/// A raised event told again at a time, without what was said of its recovery.
event_t renewed(event_t raised, estimator::Time now);

/// News of the gap between simulation and measurement as an event of kind "gap"; value in %. Its
/// place is the stiffness that has changed, or the channel with the largest gap where none has.
event_t gap_event(const estimator::GapNews& news, const Config& config);

/// The end of a raised event that is not looked for under a new configuration.
event_t withdrawn(event_t raised);

}  // namespace framewatch::daemon
