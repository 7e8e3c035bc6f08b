// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>

#include "daemon/monitor/estimates/estimate_series.h"
#include "daemon/monitor/estimation/estimation.h"
#include "daemon/tools/replay/replay_survey.h"

namespace framewatch::daemon {

/// Counts of a replay, by the names that summary and expectations use.
using ReplayCounts = std::array<std::pair<const char*, std::int64_t>, 10>;
ReplayCounts replay_counts(const Estimation& estimation);

/// Summary at the end of a replay: counts, and each parameter over all its observable windows.
struct ReplaySummary {
  const EstimateSeries& series;
  const ReplayCounts& counts;
  const ReplaySurvey& survey;
  const drivers::CanIntake& can;
  double work_s;  ///< wall time of the replay

  std::string text() const;
  /// Returns a JSON object without its closing brace, so that the caller can append members.
  std::string json() const;
};

/// Returns a line for the user that says why `motion_s` seconds of samples gave no window.
std::string why_no_window(const Config& config, const Estimation& estimation, double motion_s);

}  // namespace framewatch::daemon
