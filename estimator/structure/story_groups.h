#pragma once

#include <vector>

#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// Stories between two measured floors, of frames of one direction that share one stiffness and one
/// damping factor: what a layout with sensors on few floors shows (docs/partial.md).
struct StoryGroup {
  Direction direction = Direction::x;
  int first = 1, last = 1;       ///< stories; their floors below `last` are not measured
  std::vector<int> frames;       ///< ascending
  bool whole_direction = false;  ///< all frames of the direction
};

/// What the axes show of the frames' stories.
struct StoryGroups {
  /// Every frame has an axis of its own on every floor: all stories, and the floor panels, are
  /// identified one by one, and `groups` is empty.
  bool every_story = false;
  /// Direction x first, then by set of frames, then upward.
  std::vector<StoryGroup> groups;
};

/// What groups are asked for.
struct WantedGroups {
  /// Floors at which groups end, ascending; empty: at every measured floor.
  std::vector<int> floors = {};
  bool bending = false;  ///< frames bend: a building with a sensor everywhere has groups, too
};

/// On flexible floors a frame's groups end where the frame itself has an axis; frames without any
/// share those of the nearest one of their direction that has. On rigid floors groups end where the
/// direction is measured; two frames of a direction are told apart where every measured floor shows
/// its translations and its rotation. Forces and verticals show nothing; with one, stories are
/// groups of one where every floor is measured. Precondition: find_problems() of both is empty.
StoryGroups story_groups(const Structure& structure, const std::vector<SensorAxis>& axes,
                         const WantedGroups& wanted = {});

/// What an axis at a place of a floor measures: weights of the floor's frames (Structure::dof of
/// one story). Between frames, and on rigid floors anywhere, linear in plan.
std::vector<double> frame_weights(const Structure& structure, const SensorAxis& axis);

/// Position of a frame across its direction, m, from the first one; spans that are missing in a
/// structure that has problems count as none.
double line_position(const Structure& structure, int frame);

}  // namespace framewatch::estimator
