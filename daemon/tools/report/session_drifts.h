#pragma once

#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/monitor/estimates/session_estimates.h"
#include "daemon/monitor/event_report/drift_report.h"
#include "daemon/tools/report/session_changes.h"
#include "daemon/tools/report/session_motion.h"

namespace framewatch::daemon {

/// Peak drifts of a whole session with their errors, and what they may have done. The stiffness is
/// the median of the windows of the strong motion, or of all where it has none. Noise that is not
/// configured is measured in the record. changes: a lasting loss among them restricts the placard.
DriftReport session_drifts(const Config& config, const SessionMotion& motion,
                           const SessionEstimates& estimates,
                           const std::vector<ElementChange>& changes);

}  // namespace framewatch::daemon
