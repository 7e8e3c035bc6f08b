#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/monitor/estimates/session_estimates.h"
#include "daemon/tools/report/session_motion.h"
#include "estimator/shaking/left_out_floor.h"
#include "estimator/shaking/story_drift.h"

namespace framewatch::daemon {

/// The motion of every floor of a building with channels on some, by the parameters of the strong
/// motion, and how well a measured floor is predicted by the others.
struct SessionFloors {
  /// From 5 to 95 % of the Arias intensity of the highest measured floor, sensor time.
  std::int64_t from_us = 0, to_us = 0;
  /// Table order, SI: the median of the windows between, or of the session where there is none; the
  /// design where the session has none.
  std::vector<double> theta;
  std::vector<std::uint8_t> identified;  ///< 0: the design
  estimator::PeakResponse peak;
  /// Of each floor, the base first, and direction x, y: largest of its frames, m/s^2; NaN: none.
  std::vector<std::array<double, 2>> peak_accel_mps2;
  std::vector<std::array<bool, 2>> measured;  ///< likewise: has a channel
  std::vector<estimator::LeftOutFloor> left_out;
};

/// Rows between which the highest measured floor has 5 to 95 % of its Arias intensity.
std::pair<Eigen::Index, Eigen::Index> strong_rows(const SessionMotion& motion);

/// config: of groups of stories. Memory and time as a replay of the motion.
SessionFloors session_floors(const Config& config, const SessionMotion& motion,
                             const SessionEstimates& estimates);

/// Largest drift over height of the frames of a story along a direction (0: x); NaN: not known.
double peak_drift_ratio(const SessionFloors& floors, const estimator::Structure& structure,
                        int story, int along);

/// Schema framewatch.floors/1 (docs/formats.md).
std::string floors_json(const SessionFloors& floors, const Config& config,
                        const SessionMotion& motion);

}  // namespace framewatch::daemon
