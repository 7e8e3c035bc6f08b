// SPDX-License-Identifier: MIT
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

/// The state of the building and of its monitoring at one moment.
struct Known {
  std::vector<Finding> findings;  ///< raised ones, including acknowledged ones
  int watched = 0;                ///< stiffnesses that are watched for changes
  int with_baseline = 0;          ///< watched stiffnesses that have a baseline
  int observable = 0;             ///< watched stiffnesses that the newest window has a value of
  bool samples = false;           ///< samples have come
  double silent_s = 0;            ///< since the newest sample, host clock
  bool estimates = false;         ///< estimates have come
  double estimates_silent_s = 0;
  bool same_config = true;         ///< the estimator runs with the page's configuration
  std::optional<double> residual;  ///< ModelFit::residual()
  const Shake* newest = nullptr;
  /// Drifts of the newest shake with their errors; empty: not computed.
  std::vector<estimator::StoryDrift> drifts = {};
  const Shake* strongest = nullptr;
  std::int64_t followed_since_us = 0;        ///< sensor time of the first instant
  std::optional<EventReportSummary> report;  ///< the newest of [event_report]
};

/// good: as it should be; look: the operator should know; bad: the operator should act; wait: not
/// known yet.
enum class AnswerState { good, look, bad, wait };

/// One sentence, and the sensor times that the page shows with it; 0: no time.
struct AnswerLine {
  std::string text;
  std::int64_t since_us = 0;
  std::int64_t until_us = 0;
  std::string report = {};  ///< event report with details, without its ending; may be empty
};

struct Answer {
  std::string question;
  AnswerState state = AnswerState::wait;
  AnswerLine line = {};
  std::vector<AnswerLine> more = {};
};

/// Returns the four answers at the top of the page: whether the building changed, whether the
/// estimates can be trusted, what shaking it went through, and what to do.
std::array<Answer, 4> answers(const Known& known, const Config& config);

}  // namespace framewatch::daemon
