#pragma once

#include <optional>
#include <string>

namespace framewatch::drivers {

/// What the header of a file says of one axis. What it does not say is empty.
struct AxisHeader {
  std::optional<double> azimuth_deg;            ///< of its positive direction, clockwise from north
  std::optional<double> elevation_deg;          ///< of it, above the horizontal: 90 is up, -90 down
  std::string place;                            ///< in the network's words: "7th fl E side"
  std::optional<int> floor;                     ///< a number of it, in the network's counting
  std::optional<double> north_m, east_m, up_m;  ///< from the station's reference
  std::optional<double> latitude_deg, longitude_deg;  ///< of the sensor itself
  std::string unit;  ///< of the file's values: "cm/s2", "count"; "N" of a force

  bool operator==(const AxisHeader&) const = default;
};

/// Whether it is known to measure along a horizontal, or along the vertical.
inline bool is_horizontal(const AxisHeader& header) {
  return header.azimuth_deg && header.elevation_deg.value_or(0) == 0;
}
inline bool is_vertical(const AxisHeader& header) {
  return header.elevation_deg == 90 || header.elevation_deg == -90;
}

/// "azimuth 90 deg", "up", "down" or "direction not said".
std::string direction_text(const AxisHeader& header);

}  // namespace framewatch::drivers
