#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "estimator/structure/structure.h"

namespace framewatch::daemon {

/// Where an accelerometer of the building sits and what it measures.
struct Place {
  int story = 0;   ///< 0: base
  int frame = -1;  ///< it rides on; -1: on the base
  estimator::Direction direction = estimator::Direction::x;
  bool operator==(const Place&) const = default;
};

/// Every place that needs a channel: the base in each direction that has frames, then floor by
/// floor every frame.
std::vector<Place> places_of(const estimator::Structure& structure);

/// "base, along x" or "floor 2, frame y1, along x".
std::string place_text(const estimator::Structure& structure, const Place& place);

/// As --channel takes it: "0:x" for the base, "2:y1" for a frame; "base" and "roof" for the floor,
/// "2:x" where only one frame moves along x.
std::optional<Place> parse_place(const estimator::Structure& structure, std::string_view text);
std::string place_option(const estimator::Structure& structure, const Place& place);

/// The only frame that moves along a direction.
std::optional<int> only_frame(const estimator::Structure& structure, estimator::Direction along);

}  // namespace framewatch::daemon
