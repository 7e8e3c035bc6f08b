// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// Position and direction in plan of an axis that is not on a frame.
struct PlanPlace {
  double x_m = 0;        ///< from the first y-parallel frame
  double y_m = 0;        ///< from the first x-parallel frame
  double angle_rad = 0;  ///< direction of the positive axis, counter-clockwise from +x
};

/// One accelerometer axis and its place. Its corrected value is the absolute acceleration toward +x
/// or +y, m/s^2: polarity * (scale * raw - offset), without gravity and, on an axis mounted at an
/// angle, without the other horizontal direction (Calibration). An axis can also be a force that a
/// shaker or a hammer applies to the building; its values are in N with the same signs.
struct SensorAxis {
  std::string name;                    ///< of the channel, for people
  int story = 0;                       ///< 0 = base
  Direction direction = Direction::x;  ///< direction of the measured motion
  int frame = -1;  ///< frame that carries the axis; -1 for a base axis of the whole plan
  std::optional<PlanPlace> plan = {};  ///< replaces `frame`; `direction` is then the nearer one
  double scale = 1.0;                  ///< multiplies the raw value
  double offset = 0.0;                 ///< m/s^2, subtracted after scaling
  double polarity = 1.0;               ///< +1 or -1
  double delay = 0.0;                  ///< s, true sample instant = stamp - delay
  double tilt = 0.0;                   ///< rad, elevation of the positive axis above the horizontal
  double mount_angle = 0.0;            ///< rad, counter-clockwise in plan from `direction`
  int cross = -1;  ///< axis of the other direction that corrects for mount_angle; -1: not corrected
  double range = 0.0;  ///< m/s^2, value of scale * raw at which the sensor clips; 0: unknown
  double noise_density = 0.0;  ///< m/s^2/sqrt(Hz); 0: unknown
  std::string group = {};      ///< axes that fail together: of one node, cable or supply; "": alone
  bool check = false;          ///< compared with the prediction, not used for identification
  bool is_force = false;       ///< measures a force on the building
  /// A vertical axis of the base, positive upward, at a place in plan. Its direction has no
  /// meaning. Several of them show how the base rocks (base_rotations()).
  bool vertical = false;

  /// Returns true for an accelerometer that measures along x or y.
  bool horizontal() const { return !is_force && !vertical; }
};

/// Returns the direction that an axis measures: that of its frame, if it is on one.
Direction direction_of(const Structure& structure, const SensorAxis& axis);

/// Returns "x" or "y", or "z" for a vertical axis.
inline const char* letter(const SensorAxis& axis) {
  return axis.vertical ? "z" : letter(axis.direction);
}

/// Noise of a sensor before it is configured or measured, m/s^2/sqrt(Hz). Only ratios between axes
/// matter to the estimate: the residuals give the level.
inline constexpr double kDefaultNoiseDensity = 1e-4;
/// Returns the configured noise of every axis, or kDefaultNoiseDensity where it is not configured.
std::vector<double> noise_densities(const std::vector<SensorAxis>& axes);

/// Returns a flag for each axis: 1 if it is used for identification, 0 for a check axis.
std::vector<std::uint8_t> identifying(const std::vector<SensorAxis>& axes);
/// Returns true if any axis is a force. Without base axes the base is then at rest.
bool has_force(const std::vector<SensorAxis>& axes);
/// Returns the accelerometers along x or y of the base; without any, those of all floors.
std::vector<std::size_t> shaken_axes(const std::vector<SensorAxis>& axes);
/// Returns the accelerometers along x or y, in their order.
std::vector<SensorAxis> horizontals(const std::vector<SensorAxis>& axes);

/// Returns every way in which the sensors do not fit the structure; a problem's index is that of
/// the axis. Problems are two axes on one frame, a missing frame or story, a force on the base, no
/// axis above the base, and a direction that is measured above the base but not there. The last one
/// is allowed if a force drives the building and the base is at rest. Places without a sensor are
/// allowed: StoryGroups describes what such a layout shows.
std::vector<Problem> find_problems(const Structure& structure, const std::vector<SensorAxis>& axes);
/// Returns the messages of find_problems() for structure and sensors.
std::vector<std::string> problems(const Structure& structure, const std::vector<SensorAxis>& axes);

}  // namespace framewatch::estimator
