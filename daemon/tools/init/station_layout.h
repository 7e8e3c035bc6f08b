// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/tools/init/building_plan.h"
#include "drivers/stations/station_words.h"

namespace framewatch::daemon {

/// The building in the headers of a network's files, before it is described.
struct StationReading {
  std::vector<drivers::Level> levels;  ///< parallel to the columns
  std::vector<drivers::Side> sides;
  double azimuth_y_deg = 0;  ///< azimuth of the plan's y, the horizontal direction nearest to north
  bool along_x = false, along_y = false;  ///< directions measured in the building
  bool ground_can_be_base = false;        ///< both directions are measured on the first floor
  bool basement_can_be_base = false;      ///< both directions are measured in the basement
  int highest_floor = 0;                  ///< highest numbered floor, or 0
  bool has_roof = false;
  bool needs_plan_x = false, needs_plan_y = false;  ///< some places are given as sides of the plan
};

/// Returns nullopt if no header has both a level and a horizontal direction.
std::optional<StationReading> read_station(const std::vector<ChannelColumn>& columns);

/// The parts of the building that place a channel.
struct StationPlan {
  int stories = 1;
  bool base_is_basement = false;
  bool has_x = true, has_y = true;  ///< directions of the building's frames
  double x_m = 0, y_m = 0;          ///< lengths of the plan; 0 if unknown
};

/// Returns the place of a column's channel and if it can be used. Returns nullopt and sets `why` if
/// its header lacks the level or direction, or names a floor that this building does not have.
std::optional<StationPlace> station_place(const StationReading& reading,
                                          const std::vector<ChannelColumn>& columns, std::size_t c,
                                          const StationPlan& plan, std::string& why);

/// Returns the direction (x by default) and place in plan of a column's header, without its level.
StationPlace place_on_floor(const StationReading& reading,
                            const std::vector<ChannelColumn>& columns, std::size_t c,
                            const StationPlan& plan);

/// Returns the place as --channel takes it: "3", "base" or "roof" for the floor, "3:x", "3:y" or
/// "3:z" if the header has no direction, or "unused".
std::optional<StationPlace> parse_station_place(const std::string& text, const StationPlace& header,
                                                const StationPlan& plan);

/// Returns text such as "floor 6 of 20, along y, azimuth 0 deg, x 39.6 m".
std::string station_place_text(const StationPlace& place);

}  // namespace framewatch::daemon
