#pragma once

#include <string>
#include <vector>

#include "estimator/diagnose/model/plant.h"

namespace framewatch::estimator {

/// A test of one structural part instead of a building: one story, one frame. If the records do not
/// include the base, it is at rest.
struct ComponentTest {
  std::string force;          ///< name of the force at floor 1, N; "" if no force is measured
  bool displacement = false;  ///< floor 1 measures displacement relative to the base, m
  bool prescribed = false;    ///< the motion is prescribed, the force measured

  bool any() const { return !force.empty() || displacement; }
};

/// Returns the plant with the force axis of a component test; unchanged if no force is measured.
Plant component_plant(const Plant& plant, const ComponentTest& component);

/// Returns for each axis if it measures displacement (RecordSegment::displaced).
std::vector<char> displaced_axes(const Plant& plant, const ComponentTest& component);

}  // namespace framewatch::estimator
