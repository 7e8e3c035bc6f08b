// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/tools/init/building_plan.h"
#include "drivers/records/record.h"
#include "estimator/structure/structure.h"

namespace framewatch::daemon {

/// A point in plan, m from the first frames.
struct PlanPoint {
  double x_m = 0, y_m = 0;
  bool operator==(const PlanPoint&) const = default;
};

/// Place and direction of an accelerometer of the building.
struct Place {
  int story = 0;   ///< 0: base
  int frame = -1;  ///< it rides on; -1: on the base, or at a point
  estimator::Direction direction = estimator::Direction::x;
  std::optional<PlanPoint> at = {};  ///< replaces `frame`
  bool vertical = false;             ///< measures upward; `direction` has no meaning
  bool operator==(const Place&) const = default;
};

/// Returns 'x', 'y' or 'z'.
char letter(const Place& place);

/// Every place that needs a channel: the base in each direction that has frames, then floor by
/// floor every frame.
std::vector<Place> places_of(const estimator::Structure& structure);

/// "base, along x" or "floor 2, frame y1, along x".
std::string place_text(const estimator::Structure& structure, const Place& place);

/// Parses a place as --channel takes it: "0:x" for the base, "2:y1" for a frame, "2:x" where only
/// one frame moves along x, "2@(4,1.5):x" for a point in plan. A floor may be "base" or "roof".
/// Returns nullopt if the building has no such place.
std::optional<Place> parse_place(const estimator::Structure& structure, std::string_view text);
std::string place_option(const estimator::Structure& structure, const Place& place);

/// Parses floors: a number, "base" or "roof". Returns nullopt if the building has no such floor.
std::optional<int> parse_story(const estimator::Structure& structure, std::string_view text);

/// Returns the point in plan of a place, m. A frame and the base have it in the middle of the
/// direction that the place leaves open.
PlanPoint point_of(const estimator::Structure& structure, const Place& place);

/// Returns the places of the channels "xxy" on one floor. Several along a direction ride on frames,
/// from the first to the last, at even distances. A single one rides on the only frame of its
/// direction, or stands in the middle of the plan. `letters` has at most as many x as frames move
/// along x, and so for y.
std::vector<Place> places_on_level(const estimator::Structure& structure, int story,
                                   const std::string& letters);

/// The only frame that moves along a direction.
std::optional<int> only_frame(const estimator::Structure& structure, estimator::Direction along);

/// A candidate for a channel: a column of a record, a signal of a CAN bus or an axis of an LCM
/// node.
struct ChannelColumn {
  std::string name;
  std::string source;               ///< TOML of its `source`; empty: from files only
  double scale = 1;                 ///< m/s^2 of one
  drivers::AxisHeader header = {};  ///< what its file says of it
};

/// Place in plan and compass direction of a channel of a network's station.
struct StationPlace {
  int story = 0;
  std::string why_unused;             ///< empty: it is used
  std::optional<double> azimuth_deg;  ///< empty: `along`
  char along = 'z';                   ///< x, y, or z: vertical
  std::optional<double> x_m, y_m;     ///< empty: not known
};

struct PlannedChannel {
  Place place;
  ChannelColumn column;
  std::optional<StationPlace> station = {};  ///< instead of `place`
};

/// A building as its owner described it, SI units.
struct BuildingPlan {
  estimator::Structure structure;
  std::string mass_from;  ///< "7200 kg a floor", for a comment
  /// Stiffness of each story, all frames of a direction together, N/m. Empty without a design or
  /// such a frame.
  std::vector<double> story_kx_npm, story_ky_npm;
  std::string stiffness_from;  ///< for a comment
  double rate_hz = 100;
  std::string rate_from;
  std::vector<PlannedChannel> channels;
  bool every_frame = true;  ///< every frame has a channel on every floor, the base one a direction
  std::string can_interface, dbc;  ///< empty: no CAN
  std::string record;              ///< empty: none; with its options as `replay` takes them
  int record_files = 1;            ///< over 1: `record` is in words, `convert` makes one of them
  std::optional<double> azimuth_y_deg;  ///< of a station's building
};

/// Share of the plan that each line of frames carries, between neighbours of which these spans lie:
/// half of every span to each of its ends.
std::vector<double> shares_of_frames(const std::vector<double>& spans);

/// Mass of each node: each floor's spread over the plan by shares_of_frames() both ways. kg, as
/// Structure::node_mass.
std::vector<double> node_masses(const estimator::Structure& structure,
                                const std::vector<double>& floor_mass_kg);

/// Floor area in m^2; 0 where a direction has no span.
double floor_area_m2(const estimator::Structure& structure);

/// Stiffness of each story, equal in all of them, with which floors of these masses sway at
/// `first_hz`. N/m.
std::vector<double> story_stiffness_npm(const std::vector<double>& floor_mass_kg, double first_hz);

}  // namespace framewatch::daemon
