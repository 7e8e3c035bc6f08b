#pragma once

#include <string>

#include "drivers/records/axis_header.h"

namespace framewatch::drivers {

/// On which level of a building an instrument is, as networks say it.
enum class LevelKind {
  unknown,
  outside,   ///< free field, borehole: not in the building
  basement,  ///< any below the ground's floor
  floor,     ///< `number` counts as networks do: 1 is at the ground
  roof,
};

struct Level {
  LevelKind kind = LevelKind::unknown;
  int number = 0;
  bool operator==(const Level&) const = default;
};

/// Where on its floor: -1, 0 or 1 toward east and toward north.
struct Side {
  int east = 0, north = 0;
  bool operator==(const Side&) const = default;
};

/// "7th fl E side", "Roof", "Basement NW corner", "Ground floor", "DH array 4.6m", "3F"; a number
/// in the header's field counts where the words say nothing.
Level level_of(const AxisHeader& header);
/// "NW corner", "E side", "south wall".
Side side_of(const AxisHeader& header);

/// "floor 7", "roof", "basement", "outside".
std::string level_text(const Level& level);

}  // namespace framewatch::drivers
