#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// Where in plan an axis that rides on no frame sits, and where it points.
struct PlanPlace {
  double x_m = 0;        ///< from the first y-parallel frame
  double y_m = 0;        ///< from the first x-parallel frame
  double angle_rad = 0;  ///< of its positive axis, counter-clockwise from +x
};

/// One accelerometer axis and where it sits. Its corrected value, m/s^2, absolute, positive toward
/// +x or +y, is polarity * (scale * raw - offset), freed from gravity and from the other horizontal
/// direction where the axis is mounted at an angle (Calibration). Or a force that a shaker or a
/// hammer applies to the building there, N, of the same signs: where this says m/s^2, read N.
struct SensorAxis {
  std::string name;
  int story = 0;                       ///< 0 = base
  Direction direction = Direction::x;  ///< of the measured motion
  int frame = -1;                      ///< frame it rides on; -1 for a base axis of the whole plan
  std::optional<PlanPlace> plan = {};  ///< instead of a frame; direction is then the nearer one
  double scale = 1.0;
  double offset = 0.0;         ///< m/s^2, subtracted after scaling
  double polarity = 1.0;       ///< +1 or -1
  double delay = 0.0;          ///< s, true sample instant = stamp - delay
  double tilt = 0.0;           ///< rad, of the positive axis above the horizontal
  double mount_angle = 0.0;    ///< rad, counter-clockwise in plan from the direction it stands for
  int cross = -1;              ///< axis of the other direction that corrects for mount_angle
  double range = 0.0;          ///< m/s^2 of scale * raw, at which it clips; 0 = unknown
  double noise_density = 0.0;  ///< m/s^2/sqrt(Hz); 0 = unknown
  bool check = false;          ///< compared with what the others predict, not identified from
  bool is_force = false;       ///< of the building, not of an accelerometer
  /// Of the base at a place in plan, positive upward; its direction says nothing then. Several show
  /// how the base rocks (base_rotations()).
  bool vertical = false;

  /// An accelerometer that measures along x or y.
  bool horizontal() const { return !is_force && !vertical; }
};

/// "x", "y", or "z" of a vertical one.
inline const char* letter(const SensorAxis& axis) {
  return axis.vertical ? "z" : letter(axis.direction);
}

/// Assumed until a sensor's noise is configured or measured, m/s^2/sqrt(Hz). Only ratios between
/// axes matter to the estimate: the level is taken from the residuals.
inline constexpr double kDefaultNoiseDensity = 1e-4;
/// Configured noise of every axis, kDefaultNoiseDensity where it is not.
std::vector<double> noise_densities(const std::vector<SensorAxis>& axes);

/// Flags of the axes that are identified from: all but those for a check.
std::vector<std::uint8_t> identifying(const std::vector<SensorAxis>& axes);
/// Whether any axis is a force: without base axes the base then rests.
bool has_force(const std::vector<SensorAxis>& axes);
/// Accelerometers along x or y, in their order.
std::vector<SensorAxis> horizontals(const std::vector<SensorAxis>& axes);

/// Every way in which the sensors do not fit the structure: two axes on one frame, a frame or story
/// that does not exist, a direction that is measured above the base and not there (unless a force
/// drives the building and the base rests), no axis above the base, a force on the base. A
/// problem's index is that of the axis. Which places are left without a sensor is no problem:
/// StoryGroups says what such a layout shows.
std::vector<Problem> find_problems(const Structure& structure, const std::vector<SensorAxis>& axes);
/// Their messages.
std::vector<std::string> problems(const Structure& structure, const std::vector<SensorAxis>& axes);

}  // namespace framewatch::estimator
