// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/monitor/estimates/session_estimates.h"
#include "daemon/monitor/event_report/drift_report.h"
#include "daemon/tools/report/session_changes.h"
#include "daemon/tools/report/session_motion.h"
#include "estimator/shaking/left_out_floor.h"
#include "estimator/shaking/story_drift.h"

namespace framewatch::daemon {

/// Motion of every floor of a building with channels on some floors, computed with the parameters
/// of the strong motion, and how well a measured floor is predicted from the others.
struct SessionFloors {
  /// From 5 to 95 % of the Arias intensity of the highest measured floor, sensor time.
  std::int64_t from_us = 0, to_us = 0;
  /// Table order, SI: the median of the windows in that time. Without such windows, the median of
  /// the session; without any value, the design.
  std::vector<double> theta;
  std::vector<std::uint8_t> identified;  ///< by parameter; 0: the design
  estimator::PeakResponse peak;
  /// By floor, the base first, and direction x, y: largest of its frames, m/s^2; NaN: unknown.
  std::vector<std::array<double, 2>> peak_accel_mps2;
  std::vector<std::array<bool, 2>> measured;  ///< by floor and direction: has a channel
  std::vector<estimator::LeftOutFloor> left_out;
};

/// Computes the motion of every floor. config: of groups of stories. Takes memory and time like a
/// replay of the motion.
SessionFloors session_floors(const Config& config, const SessionMotion& motion,
                             const SessionEstimates& estimates);

/// Returns the directions that have frames, in order (0: x, 1: y).
std::vector<int> framed_directions(const estimator::Structure& structure);

/// Returns the largest drift over height of a story's frames along a direction (0: x); NaN when
/// unknown.
double peak_drift_ratio(const SessionFloors& floors, const estimator::Structure& structure,
                        int story, int along);

/// Returns JSON of schema framewatch.floors/1 (docs/formats.md).
std::string floors_json(const SessionFloors& floors, const Config& config,
                        const SessionMotion& motion);

/// Computes the peak drifts of a whole session with their errors, and the damage they may have
/// done. The stiffness is the median of the windows of the strong motion, or of all windows if no
/// window lies in it. Noise that is not configured is measured in the record. changes: a lasting
/// loss among them restricts the placard.
DriftReport session_drifts(const Config& config, const SessionMotion& motion,
                           const SessionEstimates& estimates,
                           const std::vector<ElementChange>& changes);

}  // namespace framewatch::daemon
