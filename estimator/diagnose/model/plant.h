// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "estimator/refine/window_likelihood.h"
#include "estimator/structure/matrices.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// Stories of frames that keep their shares of the design: they share one stiffness and one damping
/// factor.
struct TiedStories {
  std::vector<int> elements;  ///< in theta, the lowest story first
};

/// The building under diagnosis: its equations of motion in terms of the sensor axes, and its
/// design parameters. One equation per coordinate (degree of freedom; for rigid floors see
/// floor_constraint).
struct Plant {
  Plant(const Structure& s, const std::vector<SensorAxis>& sensors, Eigen::VectorXd believed,
        MeasuredBuilding equations);

  Structure structure;
  /// The floors are declared rigid, but the sensors could show that they are not. `structure` then
  /// has flexible floors with panels so stiff that they act as rigid.
  bool stiff_floors = false;
  double highest_hz = 0;  ///< highest natural frequency of the design
  ParameterTable table;
  std::vector<SensorAxis> axes;
  Eigen::VectorXd design;  ///< theta order, > 0
  MeasuredBuilding building;
  std::vector<Element> elements;
  Eigen::MatrixXd constraint;  ///< degrees of freedom x coordinates
  Eigen::VectorXd mass;        ///< of the coordinates, kg
  Eigen::MatrixXd motion;      ///< coordinates x axes: their absolute motion
  Eigen::MatrixXd ground;      ///< degrees of freedom x axes: the ground's motion there
  /// equations x axes: minus the direction of the force that a force axis measures; zero for other
  /// axes.
  Eigen::MatrixXd push;
  /// Component test with prescribed motion and measured force: the model's output is the force.
  bool prescribed = false;
  /// Orthonormal basis of the coordinates' motions that no axis reads (unread) and of its
  /// complement (read): coordinates x motions. The unread motions are the last columns of the
  /// building's `mass` and `sense` and of `motion`, after the axes; the equations of motion
  /// determine them. No columns if the axes read all motions.
  Eigen::MatrixXd unread, read;
  std::vector<TiedStories> groups;  ///< empty: every element has separate factors
  BendingStiffness bending;         ///< of the design

  Eigen::Index equations() const { return building.equations(); }
  Eigen::Index element_count() const { return building.elements(); }
  Eigen::Index axis_count() const { return building.axes() - unread.cols(); }
  /// Returns the equations left after eliminating the motions that no axis reads.
  Eigen::Index read_equations() const { return equations() - unread.cols(); }
  /// Returns true if fits must use less work: docs/lab/method.md, "Diagnosis of large buildings".
  bool is_large() const {
    constexpr Eigen::Index kLarge = 36;  // equations: with 40, whole fits took 20 minutes
    return equations() > kLarge;
  }
  bool is_force(Eigen::Index axis) const { return !push.col(axis).isZero(0); }
  /// Returns true if the axis drives a simulation: an axis of the base, or a force axis.
  bool is_input(Eigen::Index axis) const {
    return axes[static_cast<std::size_t>(axis)].story == 0 || is_force(axis);
  }
};

/// Returns the plant with one more axis, which measures an external force (N) on the degree of
/// freedom at the frame and story of `axis`.
Plant with_force_axis(const Plant& plant, const SensorAxis& axis);

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
