#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/monitor/event_report/event_report_files.h"
#include "daemon/page/findings/finding.h"
#include "daemon/page/findings/shaking.h"
#include "estimator/shaking/story_drift.h"

namespace framewatch::daemon {

/// What is known at a moment.
struct Known {
  std::vector<Finding> findings;  ///< raised and not cleared, acknowledged ones included
  int watched = 0;                ///< stiffnesses that changes are looked for in
  int with_baseline = 0;          ///< of them those that have a baseline
  int observable = 0;             ///< of them those that the newest window shows
  bool samples = false;           ///< some have come
  double silent_s = 0;            ///< since the newest sample, by the host's clock
  bool estimates = false;         ///< some have come
  double estimates_silent_s = 0;
  bool same_config = true;         ///< the estimator's configuration is the page's
  std::optional<double> residual;  ///< of the model
  const Shake* newest = nullptr;
  /// Of the newest shake, with their errors; empty: not computed.
  std::vector<estimator::StoryDrift> drifts = {};
  const Shake* strongest = nullptr;
  std::int64_t followed_since_us = 0;        ///< sensor time since which shakes are noticed
  std::optional<EventReportSummary> report;  ///< the newest of [event_report]
};

/// good: as it should be; look: somebody should know; bad: somebody should do something; wait: not
/// known yet.
enum class AnswerState { good, look, bad, wait };

/// One sentence, and the sensor time that belongs to it (0: none): "since".
struct AnswerLine {
  std::string text;
  std::int64_t since_us = 0;
  std::int64_t until_us = 0;
  std::string report = {};  ///< event report that says more, without its ending; empty: none
};

struct Answer {
  std::string question;
  AnswerState state = AnswerState::wait;
  AnswerLine line;
  std::vector<AnswerLine> more;
};

/// The four questions that the page begins with, in their order: is the building changed, is what
/// is shown to be believed, what did it just go through, what is to be done.
std::array<Answer, 4> answers(const Known& known, const Config& config);

}  // namespace framewatch::daemon
