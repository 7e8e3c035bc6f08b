// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "daemon/monitor/estimates/session_estimates.h"
#include "daemon/monitor/events/change_words.h"
#include "daemon/tools/report/session_motion.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/watch/change_point.h"

namespace framewatch::daemon {

/// A stiffness that has changed for good.
struct ElementChange {
  std::size_t parameter = 0;
  std::int64_t since_us = 0;            ///< sensor time
  estimator::WindowMean before, after;  ///< SI; without windows: known from an event only
  double ratio = 0, std_error = 0;      ///< relative to the value before; NaN: not known yet
  bool announced = false;               ///< the numbers are those of an event of [watch]

  bool measured() const { return before.count > 0; }
  bool sized() const { return std_error > 0; }
};

/// Returns a parameter of a log with name, kind and stories; other fields are not set.
estimator::Parameter parameter_of(const parameter_table_t& table, std::size_t parameter);

/// Returns windows of the session that do not overlap, with the parameter's values.
std::vector<estimator::WindowValue> separate_windows(const SessionEstimates& session,
                                                     std::size_t parameter);

/// Returns " (one of stories 5 to 8 may have lost up to 8 %)" for a loss of a group of stories; ""
/// for any other change.
std::string of_one_story(const parameter_table_t& table, const ElementChange& change);

/// Returns the event of a change common to all stiffnesses that is raised at the end; nullptr
/// without one.
const event_t* common_change(const SessionEstimates& session);

/// Finds the changes of stiffnesses in the main windows of a session, in order of time. A change is
/// at least 3 % (frames) or 20 % (panels) and six standard errors. For a stiffness that [watch]
/// compared with a baseline, its events alone give the changes and their sizes.
std::vector<ElementChange> session_changes(const SessionEstimates& session);

/// Removes from `changes`, and returns, those that are recovery: a stiffness that grows back toward
/// its value before an earlier loss, or grows while the motion dies away. Without `motion` (null)
/// weaker motion is recognized by the larger relative errors of its windows.
std::vector<ElementChange> take_recoveries(const SessionEstimates& session,
                                           const SessionMotion* motion,
                                           std::vector<ElementChange>& changes);

/// A stiffness with enough windows to say whether it changed.
struct JudgedElement {
  std::size_t parameter = 0;
  double shows = 0;  ///< least loss of one of its stories that would have shown, relative
};
/// Returns the stiffnesses for which session_changes() would have found a change of twice the least
/// relevant one. `shows` includes the windows' errors, the temperature's slope, and for groups the
/// model's error.
std::vector<JudgedElement> judged_elements(const SessionEstimates& session);
/// Returns why stiffnesses with enough windows are not judged; "" without such a reason.
std::string why_not_judged(const SessionEstimates& session);

/// Returns "frame y2 of story 1", "north wall (y2) of story 1" or "floor panel x1y1 of floor 2" for
/// a stiffness, and the parameter's name otherwise.
std::string element_words(const parameter_table_t& table, std::size_t parameter,
                          const FrameLabels& labels = {});

}  // namespace framewatch::daemon
