#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "daemon/estimates/session_estimates.h"
#include "daemon/report/session_motion.h"
#include "estimator/watch/change_point.h"

namespace framewatch::daemon {

/// A stiffness that has changed for good.
struct ElementChange {
  std::size_t parameter = 0;
  std::int64_t since_us = 0;            ///< sensor time
  estimator::WindowMean before, after;  ///< SI; without windows: only an event tells of it
  double ratio = 0, std_error = 0;      ///< of what it was before

  bool measured() const { return before.count > 0; }
};

/// Changes of stiffnesses within a session, as its main windows show them seen from the end, in
/// order of time: by 3 % (frames) or 20 % (panels) at least and six standard errors. Of a change
/// that only an event of the log tells, the size is the event's, against its baseline.
std::vector<ElementChange> session_changes(const SessionEstimates& session);

/// Takes out of `changes` those that are recovery: a stiffness that grows back toward what it was
/// before an earlier loss, or grows while the motion dies away. Without `motion` (null) that is
/// seen from the windows' errors over their values, which are larger where the motion is weaker.
std::vector<ElementChange> take_recoveries(const SessionEstimates& session,
                                           const SessionMotion* motion,
                                           std::vector<ElementChange>& changes);

/// Stiffnesses with windows enough that session_changes() would have found a change.
std::vector<std::size_t> judged_elements(const SessionEstimates& session);

/// "frame y2 of story 1", "floor panel x1y1 of floor 2"; the name itself where it is another's.
std::string element_words(const parameter_table_t& table, std::size_t parameter);

}  // namespace framewatch::daemon
