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

/// What is told after a strong motion. The same samples give the same.
struct EventReport {
  estimator::Shaking shaking;
  std::vector<estimator::AxisCounters> axes;  ///< what happened to the samples meanwhile
  std::vector<event_t> findings;              ///< announced meanwhile
  /// Of what every stiffness has in common; without an id: nothing.
  estimator::ChangeRecord everything{};
  std::vector<event_t> open{};  ///< alarms of other kinds that are raised when it ends
};

enum class EventColor { green, yellow, red };
const char* color_word(EventColor color);

/// By the thresholds of [event_report]. reasons: one sentence each, the gravest first; of green
/// what was looked at.
struct EventVerdict {
  EventColor color = EventColor::green;
  std::vector<std::string> reasons;
  std::string loss;              ///< the gravest lasting loss of stiffness, in words; empty: none
  int worst_story = 0;           ///< 0: no drift is known
  double worst_drift_ratio = 0;  ///< of its height
};
EventVerdict judge(const EventReport& report, const Config& config);
/// Drift and damage of every story.
DriftReport drift_report(const EventReport& report, const Config& config);

/// "event-20261124T004628Z", by the time it began; .html and .json of it are written.
std::string event_report_name(const EventReport& report);

/// As an event of kind "strong_motion": its severity is the color's, its segment the page's name.
event_t event_of(const EventReport& report, const Config& config);

/// Green is no finding, and is cleared by itself kGreenShown_s later: whether this event is due.
inline constexpr double kGreenShown_s = 600;
bool green_and_past(const event_t& event, std::int64_t now_us);

std::string event_report_html(const EventReport& report, const Config& config);
/// Schema framewatch.event_report/1, docs/formats.md.
std::string event_report_json(const EventReport& report, const Config& config);

}  // namespace framewatch::daemon
