#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>

#include "daemon/monitor/estimates/estimate_series.h"
#include "daemon/monitor/estimation/estimation.h"
#include "daemon/tools/replay/replay_survey.h"

namespace framewatch::daemon {

/// Counts of a replay's input, by the names that summary and expectations use.
using ReplayCounts = std::array<std::pair<const char*, std::int64_t>, 10>;
ReplayCounts replay_counts(const Estimation& estimation);

/// What replay prints at the end: counts, and each parameter over all its observable windows.
struct ReplaySummary {
  const EstimateSeries& series;
  const ReplayCounts& counts;
  const ReplaySurvey& survey;
  const drivers::CanIntake& can;
  double work_s;  ///< wall time the replay took

  std::string text() const;
  /// Without the closing brace: more members may follow.
  std::string json() const;
};

/// Why no window came out of `motion_s` seconds of samples, for a person.
std::string why_no_window(const Config& config, const Estimation& estimation, double motion_s);

}  // namespace framewatch::daemon
