#include "drivers/records/axis_header.h"

#include <fmt/core.h>

namespace framewatch::drivers {

std::string direction_text(const AxisHeader& header) {
  if (is_vertical(header)) return *header.elevation_deg > 0 ? "up" : "down";
  if (is_horizontal(header)) return fmt::format("azimuth {:g} deg", *header.azimuth_deg);
  if (header.azimuth_deg)
    return fmt::format("azimuth {:g} deg, {:g} deg above the horizontal", *header.azimuth_deg,
                       *header.elevation_deg);
  return "direction not said";
}

}  // namespace framewatch::drivers
