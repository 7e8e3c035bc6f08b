// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "drivers/files/file_problems.h"

namespace framewatch::drivers {

/// Describes one axis as the header of a record file does. Unknown fields are empty.
struct AxisHeader {
  std::optional<double> azimuth_deg;            ///< of the positive direction, clockwise from north
  std::optional<double> elevation_deg;          ///< of it, above the horizontal: 90 is up, -90 down
  std::string place;                            ///< in the network's words: "7th fl E side"
  std::optional<int> floor;                     ///< number of the floor, in the network's counting
  std::optional<double> north_m, east_m, up_m;  ///< from the station's reference point
  std::optional<double> latitude_deg, longitude_deg;  ///< of the sensor
  std::string unit;  ///< of the values in the file: "cm/s2", "count"; "N" for a force

  bool operator==(const AxisHeader&) const = default;
};

/// Returns true if the header says that the axis is horizontal.
inline bool is_horizontal(const AxisHeader& header) {
  return header.azimuth_deg && header.elevation_deg.value_or(0) == 0;
}
/// Returns true if the header says that the axis is vertical.
inline bool is_vertical(const AxisHeader& header) {
  return header.elevation_deg == 90 || header.elevation_deg == -90;
}

/// Returns "azimuth 90 deg", "up", "down" or "direction unknown".
std::string direction_text(const AxisHeader& header);

/// Measured or simulated motion over some time, on one clock: every sensor axis at every instant.
struct Record {
  std::vector<std::string> names;               ///< of the axes; record files call them channels
  std::vector<double> time_s;                   ///< strictly increasing
  std::vector<std::vector<double>> accel_mps2;  ///< [axis][instant]; NaN where missing
  double rate_hz = 0;                           ///< nominal: 1 / the even step
  std::vector<std::string> notes;  ///< for a person: what the reader assumed or left out
  /// Line of the file by instant; 0 for an instant that was filled in. Empty: not from a text file.
  std::vector<std::int64_t> lines;
  std::vector<AxisHeader> headers;  ///< by axis; empty: the file says nothing about its axes
};

/// The range of values of an axis beyond which they are doubted.
struct PlausibleRange {
  double scale = 1;           ///< from the axis' values to m/s^2
  double range_mps2 = 200.0;  ///< no building measured for its stiffness moves more
};

/// Larger values are refused: they are neither m/s^2 nor counts of a converter.
inline constexpr double kMaxValue = 1e12;

/// Returns one line for each thing a person should check before using the record.
/// Names for each axis the first value beyond its range, as file:line, with the number of such
/// values and the largest. Also names a rate outside 1 Hz to 10 kHz, which suggests times in
/// another unit than seconds. Appends values beyond kMaxValue to `problems` instead. `path` names
/// the file in messages; `range_of` returns the range of an axis by its name.
std::vector<std::string> implausible(
    const Record& record, const std::string& path,
    const std::function<PlausibleRange(const std::string& name)>& range_of,
    std::vector<Problem>& problems);

}  // namespace framewatch::drivers
