#pragma once

#include <string>
#include <vector>

#include "estimator/diagnose/model/plant.h"

namespace framewatch::estimator {

/// A test of one structural part instead of a building: one story, one frame. A base that the
/// records do not have is at rest.
struct ComponentTest {
  std::string force;          ///< name of the force at floor 1, N; "" when none is measured
  bool displacement = false;  ///< floor 1 measures displacement relative to the base, m
  bool prescribed = false;    ///< the motion is prescribed, the force measured

  bool any() const { return !force.empty() || displacement; }
};

/// The plant with the force axis of a component test; unchanged where no force is measured.
Plant component_plant(const Plant& plant, const ComponentTest& component);

/// Which axes measure displacement (RecordSegment::displaced).
std::vector<char> displaced_axes(const Plant& plant, const ComponentTest& component);

}  // namespace framewatch::estimator
