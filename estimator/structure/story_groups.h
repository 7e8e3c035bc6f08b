// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// Stories between two measured floors, in frames of one direction, that share one stiffness and
/// one damping factor. A layout with sensors on few floors identifies such groups
/// (docs/partial.md).
struct StoryGroup {
  Direction direction = Direction::x;  ///< of the frames
  int first = 1;                       ///< lowest story
  int last = 1;                        ///< highest story; the floors below it are not measured
  std::vector<int> frames;             ///< ascending
  bool whole_direction = false;        ///< all frames of the direction
};

/// The frame stories that the axes identify.
struct StoryGroups {
  /// Every frame has an axis on every floor. All stories and floor panels are identified one by
  /// one, and `groups` is empty.
  bool every_story = false;
  /// Direction x first, then by set of frames, then upward.
  std::vector<StoryGroup> groups;
};

/// The groups that the configuration requests.
struct WantedGroups {
  /// Floors at which groups end, ascending; empty: at every measured floor.
  std::vector<int> floors = {};
  /// Frames bend: even a building with a sensor everywhere is identified in groups.
  bool bending = false;
};

/// Returns the groups of a layout. On flexible floors, a frame's groups end where that frame has an
/// axis; frames without an axis share the groups of the nearest measured frame of their direction.
/// On rigid floors, groups end where the direction is measured; two frames of a direction are
/// separate if every measured floor shows its translations and its rotation.
///
/// Forces and vertical axes do not end groups. With one of them, stories are groups of one if
/// every floor is measured. find_problems() of structure and axes must be empty.
StoryGroups story_groups(const Structure& structure, const std::vector<SensorAxis>& axes,
                         const WantedGroups& wanted = {});

/// Returns the weights of a floor's frames (Structure::dof of one story) in the motion that an axis
/// measures. Between frames, and everywhere on a rigid floor, the motion is linear in plan.
std::vector<double> frame_weights(const Structure& structure, const SensorAxis& axis);

/// Returns the position of a frame across its direction, m, from the first frame. A span that is
/// missing in an invalid structure counts as zero.
double line_position(const Structure& structure, int frame);

}  // namespace framewatch::estimator
