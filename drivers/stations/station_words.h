// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "drivers/records/record.h"

namespace framewatch::drivers {

/// The level of a building on which an instrument is, as networks describe it.
enum class LevelKind {
  unknown,
  outside,   ///< free field, borehole: not in the building
  basement,  ///< any level below the ground floor
  floor,     ///< `number` counts as networks do: 1 is the ground floor
  roof,
};

struct Level {
  LevelKind kind = LevelKind::unknown;
  int number = 0;
  bool operator==(const Level&) const = default;
};

/// The side of its floor on which an instrument is: -1, 0 or 1 toward east and toward north.
struct Side {
  int east = 0, north = 0;
  bool operator==(const Side&) const = default;
};

/// Returns the level that header.place names: "7th fl E side", "Roof", "Basement NW corner",
/// "Ground floor", "DH array 4.6m", "3F". Falls back on header.floor; unknown when neither says it.
Level level_of(const AxisHeader& header);
/// Returns the side that header.place names: "NW corner", "E side", "south wall"; 0, 0 when
/// unknown.
Side side_of(const AxisHeader& header);

/// Returns a level for messages: "floor 7", "roof", "basement", "outside the building".
std::string level_text(const Level& level);

}  // namespace framewatch::drivers
