#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "daemon/monitor/estimates/session_estimates.h"
#include "daemon/tools/report/session_motion.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/watch/change_point.h"

namespace framewatch::daemon {

/// A stiffness that has changed for good.
struct ElementChange {
  std::size_t parameter = 0;
  std::int64_t since_us = 0;            ///< sensor time
  estimator::WindowMean before, after;  ///< SI; without windows: only an event tells of it
  double ratio = 0, std_error = 0;      ///< of what it was before; NaN: not known yet
  bool told = false;                    ///< the numbers are those of an event: the one record

  bool measured() const { return before.count > 0; }
  bool sized() const { return std_error > 0; }
};

/// A parameter of a log, as far as its words need it: name, kind and stories.
estimator::Parameter parameter_of(const parameter_table_t& table, std::size_t parameter);

/// " (one of stories 5 to 8 may have lost up to 8 %)" of a loss of a group; else empty.
std::string of_one_story(const parameter_table_t& table, const ElementChange& change);

/// Whether a change of what every stiffness has in common is raised at the end, as its event says.
const event_t* common_change(const SessionEstimates& session);

/// Changes of stiffnesses within a session, as its main windows show them seen from the end, in
/// order of time: by 3 % (frames) or 20 % (panels) at least and six standard errors. Where [watch]
/// compared a stiffness with a baseline, its events say what changed and by how much, against that
/// baseline, and nothing else is claimed.
std::vector<ElementChange> session_changes(const SessionEstimates& session);

/// Takes out of `changes` those that are recovery: a stiffness that grows back toward what it was
/// before an earlier loss, or grows while the motion dies away. Without `motion` (null) that is
/// seen from the windows' errors over their values, which are larger where the motion is weaker.
std::vector<ElementChange> take_recoveries(const SessionEstimates& session,
                                           const SessionMotion* motion,
                                           std::vector<ElementChange>& changes);

/// A stiffness of which it can be said whether it changed.
struct JudgedElement {
  std::size_t parameter = 0;
  double shows = 0;  ///< least loss of one of its stories that would have shown, relative
};
/// Stiffnesses with windows enough that session_changes() would have found a change of twice the
/// least relevant one. What shows counts the windows' errors, the temperature's slope, and of
/// groups the model's error.
std::vector<JudgedElement> judged_elements(const SessionEstimates& session);
/// Why stiffnesses are not judged though their windows would do; empty: there is no such reason.
std::string why_not_judged(const SessionEstimates& session);

/// "frame y2 of story 1", "floor panel x1y1 of floor 2"; the name itself where it is another's.
std::string element_words(const parameter_table_t& table, std::size_t parameter);

}  // namespace framewatch::daemon
