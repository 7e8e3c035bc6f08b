// SPDX-License-Identifier: MIT
#pragma once

#include <framewatch/event_t.hpp>

#include "daemon/config/config.h"
#include "daemon/monitor/events/change_words.h"
#include "estimator/gap/channel_check.h"
#include "estimator/gap/gap.h"
#include "estimator/watch/recovery.h"
#include "estimator/watch/watch.h"

namespace framewatch::daemon {

/// Returns news of a parameter's alarm as an event of kind "stiffness_change". Value and std_error
/// are in %, NaN while the record has no number. The place of a common change of all stiffnesses is
/// kWholeBuilding.
event_t stiffness_event(const estimator::Alarm& alarm, const estimator::ParameterTable& table,
                        const FrameLabels& labels);

/// Appends the recovery law's statement to the message of a stiffness event. Returns the event
/// unchanged if it is cleared, or if nothing is known yet within Recovery::kRenew_s of the strong
/// motion.
event_t recovering(event_t event, const estimator::RecoveryLaw& law);
/// Returns a raised event as news at the time `now`, without its earlier statement on recovery.
event_t renewed(event_t raised, estimator::Time now);

/// Returns news of the gap between simulation and measurement as an event of kind "gap", with its
/// value in %. The place is the stiffness that has changed, or the channel with the largest gap if
/// the change is not located.
event_t gap_event(const estimator::GapNews& news, const Config& config);

/// Returns news of a channel that misreads as an event of kind "channel_doubted". Its value is the
/// share of the reading that is not the building's motion, in %.
event_t doubt_event(const estimator::ChannelNews& news,
                    const std::vector<estimator::SensorAxis>& axes);

/// Returns the end of a raised event that the new configuration does not monitor.
event_t withdrawn(event_t raised);

}  // namespace framewatch::daemon
