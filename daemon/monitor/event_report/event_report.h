// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <framewatch/event_t.hpp>

#include "daemon/config/config.h"
#include "daemon/monitor/event_report/drift_report.h"
#include "estimator/motion/sample_merger.h"
#include "estimator/shaking/shaking_watch.h"

namespace framewatch::daemon {

/// The results of a strong motion that has ended. The same samples give the same report.
struct EventReport {
  estimator::Shaking shaking;
  std::vector<estimator::AxisCounters> axes;  ///< counters of the samples during the motion
  std::vector<event_t> findings;              ///< events announced during the motion
  /// The common change of all stiffnesses; id 0 means none.
  estimator::ChangeRecord everything{};
  std::vector<event_t> open{};  ///< alarms of other kinds that are raised when the motion ends
};

enum class EventColor { green, yellow, red };
/// Returns "green", "yellow" or "red".
const char* color_word(EventColor color);

/// The verdict by the thresholds of [event_report]. `reasons` has one sentence each, the gravest
/// first; a green verdict lists what was checked.
struct EventVerdict {
  EventColor color = EventColor::green;
  std::vector<std::string> reasons;
  std::string loss;              ///< the gravest lasting loss of stiffness, in words; empty: none
  int worst_story = 0;           ///< 0: no drift is known
  double worst_drift_ratio = 0;  ///< relative to the story's height
};
/// Judges a report by the thresholds of [event_report], which `config` must have.
EventVerdict judge(const EventReport& report, const Config& config);
/// Computes the drift and damage of every story.
DriftReport drift_report(const EventReport& report, const Config& config);

/// Returns the name of the report's .html and .json files without their ending, by the start of the
/// motion: "event-20261124T004628Z".
std::string event_report_name(const EventReport& report);

/// Returns the report as an event of kind "strong_motion". Its severity follows the color; its
/// segment is the name of the page.
event_t event_of(const EventReport& report, const Config& config);

/// A green event is cleared after this time.
inline constexpr double kGreenShown_s = 600;
/// Returns true if `event` is a green one that is to be cleared at `now_us`.
bool green_and_past(const event_t& event, std::int64_t now_us);

std::string event_report_html(const EventReport& report, const Config& config);
/// Returns the report as JSON, schema framewatch.event_report/1 (docs/formats.md).
std::string event_report_json(const EventReport& report, const Config& config);

}  // namespace framewatch::daemon
